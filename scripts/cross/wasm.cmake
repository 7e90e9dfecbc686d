# WebAssembly with Emscripten. Programs run in Node, and in browsers if they read embedded files only.
# Debian's Emscripten needs NODE_PATH=/usr/share/nodejs.
find_program(EMCC emcc REQUIRED)
get_filename_component(emscripten ${EMCC} REALPATH)
get_filename_component(emscripten ${emscripten} DIRECTORY)
# Node 18 and later have a `fetch` that cannot read files, which Emscripten up to 3.1.15 trips over.
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-experimental-fetch)
include(${emscripten}/cmake/Modules/Platform/Emscripten.cmake)
# Its find rules only search the sysroot; GTest_DIR is elsewhere.
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
set(CMAKE_CXX_FLAGS_INIT "-include ${CMAKE_CURRENT_LIST_DIR}/bit_cast.h")
# One file per program, so that a page can be opened from a folder.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-sEXIT_RUNTIME=1 -sALLOW_MEMORY_GROWTH=1 -sSINGLE_FILE=1")
