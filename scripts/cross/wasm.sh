#!/usr/bin/env bash
# Builds mien for WebAssembly with Emscripten, with SIMD128 and without, and runs the tests of kernels and engine in Node
# and in Chromium without a window. What ran is said at the end.
# usage: scripts/cross/wasm.sh           build and test
#        scripts/cross/wasm.sh bench     times frames in Node and natively, in turns, and writes docs/results/wasm.md
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-wasm
export NODE_PATH=/usr/share/nodejs  # where Debian keeps the modules that Emscripten needs

toolchain=$PWD/scripts/cross/wasm.cmake
root=build/cross/wasm
node=(node)
# Of Node 18 to 23: Emscripten up to 3.1.15 believes in its `fetch`, which cannot read files.
! node --no-experimental-fetch -e 0 2>/dev/null || node+=(--no-experimental-fetch)

configure() {  # variant, value of MIEN_WASM_SIMD, test or not
  cmake -S . -B "$root/$1" -G Ninja --toolchain "$toolchain" -DCMAKE_BUILD_TYPE=Release -DMIEN_WASM_SIMD="$2" \
    -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF -DMIEN_BUILD_TESTS=ON \
    -DCLI11_DIR="$PWD/scripts/cross/packages" -Dnlohmann_json_DIR="$PWD/scripts/cross/packages" \
    -DGTest_DIR="$PWD/$root/googletest/lib/cmake/GTest" >/dev/null
}
if [ ! -d "$root/googletest/lib/cmake/GTest" ]; then  # Debian has it for the machine's own architecture, and as source
  cmake -S /usr/src/googletest -B "$root/googletest-build" -G Ninja --toolchain "$toolchain" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PWD/$root/googletest" -DCMAKE_INSTALL_LIBDIR=lib >/dev/null
  cmake --build "$root/googletest-build" --target install >/dev/null
fi

if [ "${1:-}" = bench ]; then
  configure simd ON
  cmake --build "$root/simd" --target mien_frame_bench mien_module
  cmake --preset release >/dev/null
  cmake --build --preset release --target mien_frame_bench
  frames=$(mktemp)
  trap 'rm -f "$frames"' EXIT
  ffmpeg -v error -y -i tests/data/demo.mp4 -frames:v 120 -pix_fmt nv12 -f rawvideo "$frames"
  python3 scripts/cross/wasm_report.py "$frames" build/release/tests/tracker/frame_bench/mien_frame_bench -- \
    "${node[@]}" "$root/simd/tests/tracker/frame_bench/mien_frame_bench.js"
  exit
fi

chromium=$(command -v chromium || true)
for variant in simd plain; do
  echo "== $variant"
  configure $variant "$([ $variant = simd ] && echo ON || echo OFF)"
  cmake --build "$root/$variant" --target kernels_test engine_test mien_conformance_program mien_module
  [ $variant = plain ] || scripts/check_symbols.sh "$root/$variant" llvm-nm
  for part in kernels engine; do
    program=$root/$variant/tests/$part/${part}_test.js
    echo "-- $part, Node"
    "${node[@]}" "$program" --gtest_brief=1
    [ -z "$chromium" ] || { echo "-- $part, Chromium"; python3 scripts/cross/run_in_browser.py "$program" --gtest_brief=1; }
  done
done

bytes=$(stat -c %s "$root/simd/tracker/mien.wasm")
echo "wasm, with SIMD128 and plain: the tests of kernels and engine ran in Node $(node --version) and in ${chromium:-no browser: none is here}"
echo "wasm: the module with the whole tracker and SIMD128 has $bytes bytes ($(gzip -9c "$root/simd/tracker/mien.wasm" | wc -c) after gzip)"
echo "wasm: not run: reads past a buffer go unnoticed (there are no guard pages); not built: the mien program, the other tests"
[ "$bytes" -le 350000 ] || { echo "wasm.sh: the module is larger than 350000 bytes" >&2; exit 1; }
