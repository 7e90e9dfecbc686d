# Writes the viewer of users' avatars (apps/web/viewer.mjs) as a C++ source.
# usage: cmake -DFILE=viewer.js -DOUTPUT=viewer.cpp [-DEMPTY=ON] -P embed_viewer.cmake      reads viewer.js.z and viewer.js.sha256
cmake_minimum_required(VERSION 3.22)
set(bytes)
if(NOT EMPTY)
  file(READ ${FILE}.z hex HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
endif()
file(READ ${FILE}.sha256 hash)
file(WRITE ${OUTPUT} "// Made by embed_viewer.cmake.
#include \"apps/mien/pages/page_sources.h\"

namespace mien::app {
namespace {

constexpr char kData[] = {${bytes}'\\0'};  // ends with a zero, which does not count

}  // namespace

const std::string_view kViewer(kData, sizeof kData - 1);
const char kViewerHash[] = \"${hash}\";

}  // namespace mien::app
")
