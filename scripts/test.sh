#!/usr/bin/env bash
# Builds and tests mien on this machine, also on a fresh Debian: Release with gcc, and a build with clang's address and
# undefined-behaviour sanitizers, which also replays the fuzzing corpora.
# usage: scripts/test.sh [--quick|--all]
#   --quick: only Release
#   --all:   also runs scripts/test_rest.sh
set -euo pipefail
cd "$(dirname "$0")/.."

mode=${1:-}
case "$mode" in
  "" | --quick | --all) ;;
  *) echo "test.sh: unknown option '$mode'" >&2; exit 2 ;;
esac

scripts/setup.sh build test convert
. scripts/ccache.sh

build_and_test() {  # PRESET, options of CMake
  local began=$SECONDS built
  echo "== $1"
  cmake --preset "$@" >/dev/null
  cmake --build --preset "$1"
  built=$SECONDS
  # One more than the number of processors, because some tests mostly wait.
  ctest --preset "$1" --label-exclude compiles_again -j $(($(nproc) + 1)) --output-log "build/$1/tests.log"
  echo "== $1 was built in $((built - began)) s and tested in $((SECONDS - built)) s"
}

tests/convert/fetch_node_tests.sh || echo "NOT TESTED: ONNX's own node tests: they could not be fetched"

scripts/check/layering.sh
scripts/check/file_sizes.sh
# Sanitizers cannot test kernels that this machine does not support; Release compiles them.
avx512=ON
[ "$(uname -m)" != x86_64 ] || grep -qw avx512f /proc/cpuinfo || avx512=OFF
[ "$mode" = --quick ] || build_and_test asan-ubsan -DMIEN_WITH_AVX512=$avx512
build_and_test release
scripts/check/symbols.sh build/release
scripts/check/hardening.sh build/release

case "$mode" in
  --quick) echo "not run: sanitizers (scripts/test.sh), and the rest (scripts/test.sh --all)" ;;
  --all) scripts/test_rest.sh ;;
  *) echo "not run: linters, the library inside other projects, Release with clang, other machines, fuzzing (scripts/test.sh --all), and long tests (scripts/nightly.sh)" ;;
esac
