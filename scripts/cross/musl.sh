#!/usr/bin/env bash
# Builds mien with musl as static programs, as Alpine does, and runs the tests. Debian has no C++ library for musl; Zig from PyPI has
# one, and clang 22.
# usage: scripts/cross/musl.sh [--full]      --full: 50 seeds of mien-conformance
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build test cross-musl
. scripts/cross/common.sh
x86_64_only linux-musl

build=build/cross/linux-musl
. scripts/cross/zig_targets.sh
if ! install_zig; then
  echo "linux-musl: SKIPPED: Zig could not be installed from PyPI"
  exit
fi

echo "== linux-musl by $("$MIEN_ZIG" version)"
configure $build $build/googletest "$PWD/scripts/cross/linux-musl.cmake" -DMIEN_UNITY_BUILD=ON
build $build all
program=$build/apps/conformance/mien-conformance
if readelf --dynamic $program | grep -F NEEDED; then
  echo "musl.sh: $program needs a shared library" >&2
  exit 1
fi
$program --models models --repeat "$seeds" >$build/conformance.log || { cat $build/conformance.log >&2; exit 1; }
sed -n '/^mien /p;/^guard pages/p;$p' $build/conformance.log
if grep -qw avx2 /proc/cpuinfo && ! grep -q 'tiers: ref avx2' $build/conformance.log; then
  echo "musl.sh: $program does not detect the AVX2 of this CPU" >&2
  exit 1
fi
ctest --test-dir $build -j "$(nproc)" --output-on-failure --no-tests=error -E "^(convert|train|apps)" --output-log $build/tests.log >/dev/null ||
  { cat $build/tests.log >&2; exit 1; }
grep -E 'tests passed|Total Test time' $build/tests.log
echo "linux-musl: mien-conformance on $seeds seeds and the tests of kernels, formats, engine, audio, tracker and the C API ran as static programs"
