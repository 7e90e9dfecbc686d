#!/usr/bin/env bash
# Builds and tests the library with other compilers than the default one: no warning, all tests pass, and a clip with audio gives the same bits
# on every tier of this machine.
# usage: scripts/cross/compilers.sh [COMPILER...]      default: the oldest and the newest of Debian, g++-11 clang++-13 clang++-22
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build test compilers
. scripts/cross/common.sh
compilers=("$@")
[ $# -gt 0 ] || compilers=(g++-11 clang++-13 clang++-22)

work=build/cross/compilers
mkdir -p $work
frames=$work/frames.rgb
ffmpeg -nostdin -v error -y -i tests/data/demo.mp4 -frames:v 30 -s 640x480 -pix_fmt rgb24 -f rawvideo $frames
track() {  # compiler, build folder: a checksum of all results for each tier
  "$1" -std=c++20 -O2 -Iinclude/mien tests/package/amalgamated/main.cpp "$2/tracker/libmien.a" -o "$work/track-$1"
  "$work/track-$1" models $frames
}

cmake --preset release >/dev/null
build build/release mien_static
track c++ build/release >$work/ours.txt
for compiler in "${compilers[@]}"; do
  echo "== $("$compiler" --version | sed -n 1p)"
  build=$work/$compiler
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS=-Werror \
    -DMIEN_UNITY_BUILD=ON -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF -DMIEN_BUILD_TESTS=ON >/dev/null
  build "$build" all
  ctest --test-dir "$build" -j "$(nproc)" --output-on-failure --no-tests=error -E "^(convert|train|apps)" --output-log "$build/tests.log" >/dev/null ||
    { cat "$build/tests.log" >&2; exit 1; }
  grep -E 'tests passed|Total Test time' "$build/tests.log"
  track "$compiler" "$build" >"$work/$compiler.txt"
  diff $work/ours.txt "$work/$compiler.txt" || { echo "compilers.sh: results of $compiler differ from those of the default compiler" >&2; exit 1; }
  echo "the same bits on: $(cut -d ' ' -f 1 $work/ours.txt | xargs)"
done
