#!/usr/bin/env bash
# Builds mien and passes all its tests, on a fresh Debian machine too.
# usage: scripts/test.sh [--quick|--full]      --quick: Release with gcc only, no sanitizers, no linters, no other machines
#                                              --full: more for other machines (scripts/cross/all.sh)
set -euo pipefail
cd "$(dirname "$0")/.."

quick=0
[ "${1:-}" != "--quick" ] || quick=1

scripts/setup.sh build test convert
. scripts/ccache.sh

build() {  # preset, targets of those that are not all
  echo "== $1"
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1" ${2:+--target "${@:2}"}
}
run_tests() {  # preset
  ctest --preset "$1" -j "$(nproc)"
}

scripts/check_layering.sh
shellcheck -x scripts/*.sh scripts/cross/*.sh tests/apps/run_on_device_test.sh
if [ $quick -eq 0 ]; then
  scripts/check_format.sh
  build asan-ubsan
  run_tests asan-ubsan
  build clang mien_static mien_shared mien_program mien_conformance_program
  build/clang/apps/conformance/mien-conformance --models models
  scripts/check_tidy.sh build/clang
fi
build release
scripts/check_symbols.sh build/release
[ $quick -eq 1 ] || scripts/cross/all.sh "$@"
run_tests release
