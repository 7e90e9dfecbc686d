#!/usr/bin/env bash
# Builds mien and passes all its tests, on a fresh Debian machine too.
# usage: scripts/test.sh [--quick]      --quick: Release with gcc only, no sanitizers, no linters
set -euo pipefail
cd "$(dirname "$0")/.."

quick=0
[ "${1:-}" != "--quick" ] || quick=1

scripts/setup.sh build test convert

build() {  # preset
  echo "== $1"
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1"
}
run_tests() {  # preset
  ctest --preset "$1" -j "$(nproc)"
}

scripts/check_layering.sh
shellcheck scripts/run_on_device.sh tests/apps/run_on_device_test.sh
if [ $quick -eq 0 ]; then
  scripts/check_format.sh
  build asan-ubsan
  run_tests asan-ubsan
  build clang
  scripts/check_tidy.sh build/clang
fi
build release
scripts/check_symbols.sh build/release
run_tests release
