# Writes the avatar's script as a C++ source.
# usage: cmake -DOUTPUT=avatar.cpp -P embed_avatar.cmake
cmake_minimum_required(VERSION 3.22)
include(${CMAKE_CURRENT_LIST_DIR}/../../web/avatar/script.cmake)
avatar_script(avatar)
file(WRITE "${OUTPUT}" "// Made by embed_avatar.cmake.
#include \"apps/mien/pages/page_sources.h\"

namespace mien::app {

const char kAvatarScript[] = R\"mien(${avatar})mien\";

}  // namespace mien::app
")
