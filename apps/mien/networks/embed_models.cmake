# Writes weight files as a C++ source.
# usage: cmake -DFILES=a.mien,b.mien -DOUTPUT=embedded_models.cpp -P embed_models.cmake
cmake_minimum_required(VERSION 3.22)

string(REPLACE "," ";" FILES "${FILES}")
set(arrays)
set(entries)
foreach(file IN LISTS FILES)
  get_filename_component(stem ${file} NAME_WE)
  file(SIZE ${file} bytes)
  math(EXPR rest "${bytes} % 8")
  if(NOT rest EQUAL 0)
    message(FATAL_ERROR "${file}: size is not a multiple of 8 (got ${bytes} bytes)")
  endif()
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)(..)(..)(..)(..)(..)(..)(..)" "0x\\8\\7\\6\\5\\4\\3\\2\\1u," words "${hex}")
  string(APPEND arrays "constexpr std::uint64_t ${stem}[] = {${words}};\n")
  string(APPEND entries "    {\"${stem}.mien\", std::as_bytes(std::span(${stem}))},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by embed_models.cmake. Little-endian, as the files are.
#include \"apps/mien/networks/embedded_models.h\"

#include <cstdint>

namespace mien::app {
namespace {

${arrays}
const EmbeddedModel models[] = {
${entries}};

}  // namespace

std::span<const EmbeddedModel> embedded_models() { return models; }

}  // namespace mien::app
")
