#!/usr/bin/env bash
# Builds mien and passes its tests on this machine, a fresh Debian too: Release with gcc, and clang's address and
# undefined-behaviour sanitizers, under which the fuzzing corpora are replayed.
# usage: scripts/test.sh [--quick|--all]
#   --quick: Release alone
#   --all:   then the rest, too: scripts/test_rest.sh
set -euo pipefail
cd "$(dirname "$0")/.."

mode=${1:-}
case "$mode" in
  "" | --quick | --all) ;;
  *) echo "test.sh: unknown option '$mode'" >&2; exit 2 ;;
esac

scripts/setup.sh build test convert
. scripts/ccache.sh

build_and_test() {  # preset, options of CMake
  local began=$SECONDS built
  echo "== $1"
  cmake --preset "$@" >/dev/null
  cmake --build --preset "$1"
  built=$SECONDS
  # One more than there are processors, since some tests wait most of the time.
  ctest --preset "$1" --label-exclude compiles_again -j $(($(nproc) + 1)) --output-log "build/$1/tests.log"
  echo "== $1 was built in $((built - began)) s and tested in $((SECONDS - built)) s"
}

tests/convert/fetch_node_tests.sh || echo "NOT TESTED: ONNX's own node tests, which could not be fetched"

scripts/check/layering.sh
# Sanitizers find nothing in kernels that this machine cannot run; Release compiles them.
avx512=ON
[ "$(uname -m)" != x86_64 ] || grep -qw avx512f /proc/cpuinfo || avx512=OFF
[ "$mode" = --quick ] || build_and_test asan-ubsan -DMIEN_WITH_AVX512=$avx512
build_and_test release
scripts/check/symbols.sh build/release
scripts/check/hardening.sh build/release

case "$mode" in
  --quick) echo "left out: the sanitizers (scripts/test.sh), and what scripts/test.sh --all has" ;;
  --all) scripts/test_rest.sh ;;
  *) echo "left out: linters, the library inside other projects, Release with clang, other machines, fuzzing (scripts/test.sh --all); what takes hours (scripts/nightly.sh)" ;;
esac
