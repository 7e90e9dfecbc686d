#!/usr/bin/env bash
# Builds mien for Windows (x86-64) with MinGW-w64 and runs mien-conformance, the tests of kernels and engine, the tracker on the
# demo clip, under Wine. The last lines list what ran.
# usage: scripts/cross/windows.sh [--full]      --full: 50 seeds of mien-conformance, and the program beside that of this machine
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-windows
. scripts/cross/common.sh
export WINEDEBUG=-all  # hides messages about the missing 32-bit part of Wine
export WINEPREFIX=$PWD/build/cross/wine

build=build/cross/windows-x64
mkdir -p "$WINEPREFIX"
wine wineboot --init >/dev/null 2>&1

echo "== windows-x64"
configure $build $build/googletest "$PWD/scripts/cross/windows-x64.cmake" -DMIEN_BUILD_APPS=ON
build $build mien_static mien_shared kernels_test engine_test mien_conformance_program mien_frame_bench mien_program

# GCC bug 54412: no move of a whole AVX register may insist on an alignment that the stack does not have.
find $build/kernels -name '*.obj' | while read -r object; do
  if x86_64-w64-mingw32-objdump -d "$object" | grep -E '\svmov(aps|apd|dqa)[0-9]*\s.*%[yz]mm' >/dev/null; then
    echo "windows.sh: $object has aligned moves of AVX registers" >&2
    exit 1
  fi
done

program=$build/apps/conformance/mien-conformance.exe
conformance wine $program --self-test
conformance wine $program --repeat "$seeds"
for part in kernels engine; do
  echo "-- $part, Wine"
  wine $build/tests/$part/${part}_test.exe --gtest_brief=1
done
frames=$(mktemp)
trap 'rm -f "$frames"' EXIT
ffmpeg -v error -y -i tests/data/demo.mp4 -frames:v 20 -pix_fmt nv12 -f rawvideo "$frames"
wine $build/tests/tracker/frame_bench/mien_frame_bench.exe models "$frames" 640 480 avx2

# Not by default: it fetches two programs of 80 MB each.
program_beside_ours() {
  local ffmpeg_folder
  if ! ffmpeg_folder=$(scripts/cross/install_windows_ffmpeg.sh); then
    echo "SKIPPED: the program did not run: no ffmpeg.exe could be installed from PyPI and npm" >&2
    return
  fi
  cmake --preset release >/dev/null
  build build/release mien_program
  # Starts Wine's services first, because one may crash on startup and print messages between those of the program.
  wineserver -k || true
  wineserver -p
  wine wineboot >/dev/null 2>&1
  trap 'rm -f "$frames"; wineserver -k' EXIT
  python3 tests/apps/windows_test.py $build/apps/mien/mien.exe build/release/apps/mien/mien "$ffmpeg_folder"
  ran_program="the program tracked, converted and sent the same as on this machine"
}
ran_program="the program did not run (--full)"
[ "$full" = 0 ] || program_beside_ours

echo "windows-x64: mien-conformance on $seeds seeds, the tests of kernels and engine, and the tracker at level 4 on 20 frames ran under $(wine --version); $ran_program"
echo "windows-x64: only compiled: the shared library; not built: the other tests, which need POSIX"
