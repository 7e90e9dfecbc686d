#!/usr/bin/env bash
# Writes docs/results/arm.md: what llvm-mca predicts of the NEON inner loops, and the instructions of networks, counted
# under emulation.
# usage: scripts/cross/arm_report.sh [OUT_FILE]
set -euo pipefail
cd "$(dirname "$0")/../.."
out=${1:-docs/results/arm.md}
work=$PWD/build/cross
scripts/setup.sh build cross-arm

. scripts/ccache.sh
build_library() {  # folder, options of cmake
  local folder=$work/$1
  shift
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF \
    -DMIEN_BUILD_TESTS=OFF -DMIEN_BUILD_CONFORMANCE=OFF "$@" >/dev/null
  cmake --build "$folder" --target mien_static >/dev/null
}
build_library report-arm64 --toolchain "$PWD/scripts/cross/linux-arm64.cmake"
build_library report-x64 -DMIEN_BUILD_CONFORMANCE=ON
cmake --build "$work/report-x64" --target mien_conformance_program >/dev/null

program=scripts/cross/run_network.cpp
options="-std=c++20 -O2 -static -Iinclude"
# shellcheck disable=SC2086
aarch64-linux-gnu-g++ $options $program "$work/report-arm64/tracker/libmien.a" -o "$work/run_neon"
# shellcheck disable=SC2086
g++ $options $program "$work/report-x64/tracker/libmien.a" -o "$work/run_avx2"
gcc -O2 -Wall -Wextra -shared -fPIC scripts/cross/count_plugin.c -o "$work/libcount.so"

# The same kernels by clang, against the cross compiler's headers.
by_clang() {  # tier, its flags and sources
  local tier=$1 flags=$2
  for source in "${@:3}"; do
    mkdir -p "$work/clang/$tier/$(dirname "$source")"
    # shellcheck disable=SC2086
    clang++ --target=aarch64-linux-gnu -std=c++20 -O3 -DNDEBUG -fPIC -fno-exceptions -fno-rtti -I. $flags \
      -DMIEN_TIER="$tier" -c "kernels/$source.cpp" -o "$work/clang/$tier/$source.cpp.o"
  done
}
by_clang neon "-DMIEN_HAVE_NEON" pointwise/neon_product inverted_residual/neon lstm/neon
by_clang neonfp16 "-DMIEN_HAVE_NEON -DMIEN_HAVE_NEONFP16 -DMIEN_HALF_TIER -march=armv8.2-a+fp16" \
  inverted_residual/neonfp16_product inverted_residual/neonfp16 lstm/neon
by_clang neondot "-march=armv8.2-a+fp16+dotprod" inverted_residual/neondot_product
by_clang neoni8mm "-march=armv8.2-a+fp16+i8mm" inverted_residual/neoni8mm_product
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=apps/convert python3 scripts/cross/arm_report.py "$work" "$out"
