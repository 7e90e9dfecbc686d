#!/usr/bin/env bash
# Builds the library, and a program in C# that uses it, with Debian's mono.
# usage: bindings/csharp/build.sh PROGRAM.cs      the result is build/csharp/PROGRAM.exe, with libmien.so beside it
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../.."
scripts/setup.sh build csharp
. scripts/ccache.sh
out=build/csharp
cmake -S . -B $out/library -G Ninja -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_TESTS=OFF -DMIEN_BUILD_APPS=OFF -DMIEN_BUILD_CONFORMANCE=OFF >/dev/null
cmake --build $out/library --target mien_shared
cp -L $out/library/tracker/libmien.so $out/
mcs -out:"$out/$(basename "$program" .cs).exe" bindings/csharp/Runtime/*.cs "$program"
