#!/usr/bin/env bash
# Runs the programs built for this machine under an emulator, on x86 CPUs without AVX2 and with AVX2 only: they must choose
# kernels that the CPU supports.
# usage: scripts/cross/linux_x64.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build test cross-x86
. scripts/cross/common.sh
x86_64_only linux-x64

cmake --preset release >/dev/null
build build/release mien_conformance_program kernels_test engine_test
program=build/release/apps/conformance/mien-conformance

expect_tiers() {  # CPU model, tiers
  local header
  header=$(MIEN_MODELS='' scripts/run_on_device.sh "qemu:$1" $program --filter softmax | sed -n 1p)
  case $header in
    *"tiers: $2;"*) echo "-- $1: tiers: $2" ;;
    *) echo "linux_x64.sh: $1 should have the tiers $2: $header" >&2; exit 1 ;;
  esac
}

echo "== linux-x64 under $(qemu-x86_64 --version | sed -n 1p)"
expect_tiers Nehalem ref            # SSE4.2
expect_tiers SandyBridge ref        # AVX
expect_tiers max,-fma ref           # AVX2 alone
expect_tiers max "ref avx2"         # the emulator has no AVX-512
conformance qemu:Nehalem $program
for part in kernels engine; do
  echo "-- $part, Nehalem"
  qemu-x86_64 -cpu Nehalem build/release/tests/$part/${part}_test --gtest_brief=1
done
# AVX2 is slow here, and other jobs run it natively. Excludes matrix_vector, because QEMU 7.2 reads lanes outside the mask of a load, and
# networks, which flush denormal numbers to zero: QEMU 7.2 then also flushes those of half precision, unlike a CPU.
for filter in pointwise depthwise lstm warp; do
  MIEN_MODELS='' conformance qemu:max $program --tier avx2 --filter "$filter"
done

echo "linux-x64: mien-conformance and the tests of kernels and engine ran on a CPU without AVX2 (Nehalem), some kernels on one with AVX2 and no AVX-512"
