# Writes a C++ source with the page of `mien compare`, put together from its parts.
# usage: cmake -DPAGE=page.html -DSTYLE=page.css -DSCRIPTS=a.js,b.js -DOUTPUT=page_source.cpp -P embed.cmake
cmake_minimum_required(VERSION 3.22)  # old policies would expand the marks as variables

file(READ "${PAGE}" page)
file(READ "${STYLE}" style)
string(REPLACE "," ";" SCRIPTS "${SCRIPTS}")
set(script "")
foreach(path IN LISTS SCRIPTS)
  file(READ "${path}" part)
  string(APPEND script "${part}")
endforeach()
string(REPLACE "@STYLE@" "${style}" page "${page}")
string(REPLACE "@SCRIPT@" "${script}" page "${page}")
file(WRITE "${OUTPUT}" "// Made by embed.cmake from the files in apps/mien/compare.
#include \"apps/mien/compare/page_source.h\"

namespace mien::app {

const char kPageSource[] = R\"mien(${page})mien\";

}  // namespace mien::app
")
