# Writes the viewer of users' avatars (apps/web/viewer.mjs) as a C++ source.
# usage: cmake -DFILE=viewer.js -DOUTPUT=viewer.cpp -P embed_viewer.cmake      reads viewer.js.z and viewer.js.sha256
cmake_minimum_required(VERSION 3.22)
file(READ ${FILE}.z hex HEX)
string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
file(READ ${FILE}.sha256 hash)
file(WRITE ${OUTPUT} "// Made by embed_viewer.cmake.
#include \"apps/mien/pages/page_sources.h\"

namespace mien::app {
namespace {

constexpr char kData[] = {${bytes}};

}  // namespace

const std::string_view kViewer(kData, sizeof kData);
const char kViewerHash[] = \"${hash}\";

}  // namespace mien::app
")
