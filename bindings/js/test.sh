#!/usr/bin/env bash
# Runs the tests of the npm package in Node, with the module that Emscripten builds.
# usage: bindings/js/test.sh      (scripts/setup.sh build web test)
set -euo pipefail
cd "$(dirname "$0")/../.."
for tool in emcc node ffmpeg clang; do
  command -v "$tool" >/dev/null || { echo "NOT TESTED: bindings/js needs $tool (scripts/setup.sh build web test)"; exit 0; }
done
. scripts/ccache.sh
export NODE_PATH=/usr/share/nodejs  # Debian's folder of modules that Emscripten needs
cmake -S . -B build/wasm -G Ninja --toolchain scripts/cross/wasm.cmake -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_APPS=OFF \
  -DMIEN_BUILD_CONFORMANCE=OFF -DMIEN_BUILD_TESTS=OFF -DMIEN_INSTALL=OFF >/dev/null
cmake --build build/wasm --target mien_module -- --quiet
MIEN_C_API32=$PWD/build/wasm/c_api32.txt
export MIEN_C_API32
bindings/c_api.py wasm32 >"$MIEN_C_API32"
node --test --test-reporter=spec bindings/js/tests/*.test.mjs
