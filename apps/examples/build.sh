#!/usr/bin/env bash
# Builds the library, and a program in C or C++ that uses it.
# usage: apps/examples/build.sh PROGRAM.c|PROGRAM.cpp      the result is build/PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../.."
scripts/setup.sh build demo
. scripts/ccache.sh
cmake -S . -B build/library -G Ninja -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_TESTS=OFF -DMIEN_BUILD_APPS=OFF -DMIEN_BUILD_CONFORMANCE=OFF >/dev/null
cmake --build build/library --target mien_static
name=$(basename "$program")
case $name in
  *.c) compiler=("${CC:-cc}") ;;
  *) compiler=("${CXX:-c++}" -std=c++20) ;;
esac
"${compiler[@]}" -O2 -Iinclude "$program" -o "build/${name%.*}" build/library/tracker/libmien.a -lstdc++ -lm
