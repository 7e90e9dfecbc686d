#!/usr/bin/env bash
# Builds mien for Windows (x86-64) with MinGW-w64 and runs the tests of kernels and engine, and the whole tracker on the
# demo clip, under Wine. What ran is said at the end.
# usage: scripts/cross/windows.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-windows
export WINEDEBUG=-all  # Wine speaks of a 32-bit half that nobody needs
export WINEPREFIX=$PWD/build/cross/wine

toolchain=$PWD/scripts/cross/windows-x64.cmake
build=build/cross/windows-x64
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
mkdir -p "$WINEPREFIX"
wine wineboot --init >/dev/null 2>&1

if [ ! -d "$build/googletest/lib/cmake/GTest" ]; then
  cmake -S /usr/src/googletest -B "$build/googletest-build" -G Ninja --toolchain "$toolchain" "${launcher[@]}" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PWD/$build/googletest" -DCMAKE_INSTALL_LIBDIR=lib >/dev/null
  cmake --build "$build/googletest-build" --target install >/dev/null
fi
cmake -S . -B "$build" -G Ninja --toolchain "$toolchain" "${launcher[@]}" -DCMAKE_BUILD_TYPE=Release \
  -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF -DMIEN_BUILD_TESTS=ON \
  -DCLI11_DIR="$PWD/scripts/cross/packages" -Dnlohmann_json_DIR="$PWD/scripts/cross/packages" \
  -DGTest_DIR="$PWD/$build/googletest/lib/cmake/GTest" >/dev/null
cmake --build "$build" --target mien_static mien_shared kernels_test engine_test mien_conformance_program mien_frame_bench

# GCC bug 54412: no move of a whole AVX register may insist on an alignment that the stack does not have.
for object in $(find "$build/kernels" -name '*.obj'); do
  if x86_64-w64-mingw32-objdump -d "$object" | grep -qE '\svmov(aps|apd|dqa)[0-9]*\s.*%[yz]mm'; then
    echo "windows.sh: $object has aligned moves of AVX registers" >&2
    exit 1
  fi
done

for part in kernels engine; do
  echo "-- $part, Wine"
  wine "$build/tests/$part/${part}_test.exe" --gtest_brief=1
done
frames=$(mktemp)
trap 'rm -f "$frames"' EXIT
ffmpeg -v error -y -i tests/data/demo.mp4 -frames:v 20 -pix_fmt nv12 -f rawvideo "$frames"
wine "$build/tests/tracker/frame_bench/mien_frame_bench.exe" models "$frames" 640 480 avx2

echo "windows-x64: the tests of kernels and engine, and the tracker at level 4 on 20 frames, ran under $(wine --version)"
echo "windows-x64: only compiled: the shared library; not built: the mien program and the other tests, which need POSIX"
