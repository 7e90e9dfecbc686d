# Writes the packed avatar as a C++ source.
# usage: cmake -DFILE=avatar.packed -DOUTPUT=avatar_data.cpp -P embed_avatar.cmake
cmake_minimum_required(VERSION 3.22)
file(READ ${FILE} hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
file(WRITE ${OUTPUT} "// Made by embed_avatar.cmake.
#include \"apps/animation/avatar_data.h\"

namespace mien::animation {
namespace {

constexpr unsigned char kData[] = {${bytes}};

}  // namespace

std::span<const std::byte> avatar_data() { return std::as_bytes(std::span(kData)); }

}  // namespace mien::animation
")
