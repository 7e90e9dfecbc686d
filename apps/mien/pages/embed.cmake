# Assembles a page from its parts and writes it as a C++ source. The page's content security policy permits only the style and script
# with these hashes. The script begins with the avatar, which all pages share: @AVATAR@ stands for it.
# usage: cmake -DNAME=kPage -DPAGE=page.html -DSTYLES=a.css,b.css -DSCRIPTS=a.js,b.js -DOUTPUT=page.cpp -P embed.cmake
cmake_minimum_required(VERSION 3.22)  # old policies would expand the marks as variables

# Sets `result` to the contents of files, given as a comma-separated list.
function(read_all result files)
  set(all "")
  string(REPLACE "," ";" files "${files}")
  foreach(path IN LISTS files)
    file(READ "${path}" part)
    string(APPEND all "${part}")
  endforeach()
  set(${result} "${all}" PARENT_SCOPE)
endfunction()

# Sets `result` to the SHA-256 of the text in base64, as Content-Security-Policy requires.
function(hash_of result text)
  set(digits "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
  string(SHA256 hex "${text}")
  set(base64 "")
  foreach(at RANGE 0 60 6)  # 3 bytes per step; the last step has two
    string(SUBSTRING "${hex}00" ${at} 6 three_bytes)
    foreach(shift 18 12 6 0)
      math(EXPR digit "(0x${three_bytes} >> ${shift}) & 63")
      string(SUBSTRING "${digits}" ${digit} 1 digit)
      string(APPEND base64 "${digit}")
    endforeach()
  endforeach()
  string(SUBSTRING "${base64}" 0 43 base64)
  set(${result} "sha256-${base64}=" PARENT_SCOPE)
endfunction()

file(READ "${PAGE}" page)
read_all(style "${STYLES}")
string(REGEX REPLACE "\n +" "\n" style "${style}")
include(${CMAKE_CURRENT_LIST_DIR}/../../web/avatar/script.cmake)
avatar_script(avatar)
read_all(script "${SCRIPTS}")
classic_script(script "${script}")
hash_of(style_hash "${style}")
hash_of(script_hash "'use strict';\n${avatar}${script}")
set(script "'use strict';\n@AVATAR@${script}")
foreach(mark style_hash script_hash style script)
  string(TOUPPER "@${mark}@" written)
  string(REPLACE "${written}" "${${mark}}" page "${page}")
endforeach()
file(WRITE "${OUTPUT}" "// Made by embed.cmake of ${PAGE}.
#include \"apps/mien/pages/page_sources.h\"

namespace mien::app {

const char ${NAME}[] = R\"mien(${page})mien\";

}  // namespace mien::app
")
