#!/usr/bin/env bash
# Builds mien for another machine and runs its tests under an emulator, once per CPU model.
# usage: scripts/cross/test.sh linux-arm64|linux-armv7
# What ran, and what was only compiled, is said at the end.
set -euo pipefail
cd "$(dirname "$0")/../.."

target=${1:?linux-arm64 or linux-armv7}
case "$target" in
  linux-arm64)  # ARMv8.0 without fp16 arithmetic, ARMv8.2 with it, and all that the emulator knows
    models="cortex-a53 cortex-a57 cortex-a72 cortex-a76 neoverse-n1 max" ;;
  linux-armv7)  # without VFPv4 (so without a NEON tier), then with
    models="cortex-a9 cortex-a7 cortex-a15 max" ;;
  *) echo "test.sh: unknown target '$target'" >&2; exit 2 ;;
esac
scripts/setup.sh build cross-arm

build=build/cross/$target
toolchain=$PWD/scripts/cross/$target.cmake
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

# Debian has GoogleTest for the machine's own architecture only, but its source for all.
if [ ! -d "$build/googletest/lib/cmake/GTest" ]; then
  cmake -S /usr/src/googletest -B "$build/googletest-build" -G Ninja --toolchain "$toolchain" "${launcher[@]}" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PWD/$build/googletest" -DCMAKE_INSTALL_LIBDIR=lib >/dev/null
  cmake --build "$build/googletest-build" --target install >/dev/null
fi
cmake -S . -B "$build" -G Ninja --toolchain "$toolchain" "${launcher[@]}" -DCMAKE_BUILD_TYPE=Release \
  -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF -DMIEN_BUILD_TESTS=ON \
  -DGTest_DIR="$PWD/$build/googletest/lib/cmake/GTest" >/dev/null
cmake --build "$build"
cmake --build "$build" --target mien_shared
scripts/check_symbols.sh "$build"
scripts/check_tidy.sh "$build" kernels

# Kernels and the engine's golden answers on every CPU model; the rest, which is slow under emulation, on the first.
# Not train and apps: those need Python and ffmpeg, which are not built for that machine.
run_tests() {  # CPU model, ctest's choice of tests
  echo "== $target as $1"
  QEMU_CPU=$1 ctest --test-dir "$build" -j "$(nproc)" --output-on-failure --no-tests=error "${@:2}" |
    tee "$build/ctest-$1.log" | grep -E 'tests passed|Failed|Timeout'
}
for model in $models; do
  run_tests "$model" -R '^(Kernels|Faults|Harness|Inputs/PointwiseSizes|.*Golden|PublishedNetworks)'
done
run_tests "${models%% *}" -E '^(train|apps|install|convert|Kernels|Faults|Harness|Inputs/PointwiseSizes)'

echo "$target: tests of kernels and the engine's golden answers ran as: $models"
echo "$target: tests of formats, engine, audio, tracker and the C API ran as: ${models%% *}"
echo "$target: the shared library was only compiled; the mien program was not built"
