#!/usr/bin/env bash
# Builds mien for WebAssembly with Emscripten, with SIMD128 and without, and runs the tests of kernels and engine in Node
# and in headless Chromium, and mien-conformance in Node. The last lines list what ran.
# usage: scripts/cross/wasm.sh [--full]   build and test; --full: 50 seeds of mien-conformance
#        scripts/cross/wasm.sh bench      times frames in Node and natively, interleaved, and writes docs/results/wasm.md
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-wasm
. scripts/cross/common.sh
export NODE_PATH=/usr/share/nodejs  # where Debian keeps the modules that Emscripten needs

toolchain=$PWD/scripts/cross/wasm.cmake
root=build/cross/wasm
node=(node)
# For Node 18 to 23: Emscripten up to 3.1.15 uses its `fetch`, which cannot read files.
! node --no-experimental-fetch -e 0 2>/dev/null || node+=(--no-experimental-fetch)

configure_variant() {  # simd or plain
  configure "$root/$1" "$root/googletest" "$toolchain" -DMIEN_WASM_SIMD="$([ "$1" = simd ] && echo ON || echo OFF)"
}

tidy() {
  local sysroot
  sysroot=$(em++ --cflags | grep -oE -- '--sysroot=[^ ]+')  # em++ is clang with its own target and headers
  git ls-files 'kernels/*/wasm*.cpp' 'kernels/*/simd.cpp' | xargs -P "$(nproc)" -n 1 clang-tidy -p "$root/simd" --quiet \
    --extra-arg-before=--target=wasm32-unknown-emscripten --extra-arg-before="$sysroot" \
    --checks=-bugprone-dynamic-static-initializers `# it takes constants of class templates for variables` \
    2> >(grep -v ' warnings\? generated' >&2 || true)
}

if [ "${1:-}" = bench ]; then
  configure_variant simd
  build "$root/simd" mien_frame_bench mien_module
  cmake --preset release >/dev/null
  build build/release mien_frame_bench
  frames=$(mktemp)
  trap 'rm -f "$frames"' EXIT
  ffmpeg -v error -y -i tests/data/demo.mp4 -frames:v 120 -pix_fmt nv12 -f rawvideo "$frames"
  python3 scripts/cross/wasm_report.py "$frames" build/release/tests/tracker/frame_bench/mien_frame_bench -- \
    "${node[@]}" "$root/simd/tests/tracker/frame_bench/mien_frame_bench.js"
  exit
fi

chromium=$(command -v chromium || true)
for variant in simd plain; do
  echo "== wasm, $variant"
  configure_variant $variant
  build "$root/$variant" kernels_test engine_test mien_conformance_program mien_module
  [ $variant = plain ] || { scripts/check/symbols.sh "$root/$variant" llvm-nm; tidy; }
  program=$root/$variant/apps/conformance/mien-conformance.js
  conformance node "$program" --self-test
  conformance node "$program" --repeat "$seeds"
  for part in kernels engine; do
    program=$root/$variant/tests/$part/${part}_test.js
    echo "-- $part, Node"
    "${node[@]}" "$program" --gtest_brief=1
    [ -z "$chromium" ] || { echo "-- $part, Chromium"; python3 scripts/cross/run_in_browser.py "$program" --gtest_brief=1; }
  done
done

bytes=$(stat -c %s "$root/simd/tracker/mien.wasm")
echo "wasm, with SIMD128 and plain: the tests of kernels and engine ran in Node $(node --version) and in ${chromium:-no browser: none is here}"
echo "wasm, with SIMD128 and plain: mien-conformance ran in Node, $seeds seeds"
echo "wasm: the module with the whole tracker and SIMD128 has $bytes bytes ($(gzip -9c "$root/simd/tracker/mien.wasm" | wc -c) after gzip)"
echo "wasm: not run: reads past a buffer go unnoticed (there are no guard pages); not built: the mien program, the other tests"
[ "$bytes" -le 350000 ] || { echo "wasm.sh: the module is larger than 350000 bytes" >&2; exit 1; }
