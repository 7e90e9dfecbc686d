#!/usr/bin/env bash
# Builds mien for an ARM machine and runs its tests under an emulator, the kernels once per CPU model; or for 32-bit x86, whose programs
# run on an x86-64 machine as they are.
# usage: scripts/cross/test.sh linux-arm64|linux-armv7|linux-i386 [--full]
#   --full: also more CPU models, the tests that take longest under emulation (`slow` below), and mien-conformance on 50 seeds, not
#   one: hours
# Exit status 0 only if everything passes. Prints at the end which tests ran, and which parts were only compiled.
set -euo pipefail
cd "$(dirname "$0")/../.."

target=${1:?linux-arm64, linux-armv7 or linux-i386}
. scripts/cross/common.sh
packages_of=cross-arm
case "$target" in
  linux-arm64)  # ARMv8.0 without fp16 arithmetic, and all that the emulator knows, fp16 among it
    models="cortex-a53 max" more_models="cortex-a72 cortex-a76 neoverse-n1"
    emulator="qemu-aarch64 -L /usr/aarch64-linux-gnu" nm=aarch64-linux-gnu-nm ;;
  linux-armv7)  # without VFPv4 (so without a NEON tier), then with
    models="cortex-a9 cortex-a7" more_models="cortex-a15 max"
    emulator="qemu-arm -L /usr/arm-linux-gnueabihf" nm=arm-linux-gnueabihf-nm ;;
  linux-i386)  # the reference alone
    models="native" more_models="" packages_of=cross-i386
    emulator="/usr/i686-linux-gnu/lib/ld-linux.so.2 --library-path /usr/i686-linux-gnu/lib" nm=i686-linux-gnu-nm ;;
  *) echo "test.sh: unknown target '$target'" >&2; exit 2 ;;
esac
case "${2:-}" in
  "") full=0 seeds=1 ;;
  --full) full=1 seeds=50 models+="${more_models:+ $more_models}" ;;
  *) echo "test.sh: unknown option '$2'" >&2; exit 2 ;;
esac

# Excludes tests that start programs, which a machine without binfmt_misc cannot do for another machine, and the cases of kernels,
# which mien-conformance runs before.
elsewhere='ConformanceProgram|conformance\.|package|convert|train|apps|(formats|animation)\.locale|protocols\.packets|Kernels/Conformance'
# Tests that an emulator runs only with --full: they take more than a tenth of a second natively, and seconds under emulation (long streams
# and clips). Every part, and the trained networks, keep at least one test.
slow='Allocation\.CreateAllocatesOnce|Calibration\.|Equivariance\.|FrontEnd\.FeaturesDoNotDependOnBlockSize|Images\.(MayHaveAnySize|MayBeFourK)'
slow+='|Levels\.|Reset\.|Resampler\.(Outputs?|Passes|Attenuates)|SeveralFaces\.([^DRT]|DetectsNew|TracksAtMost|TheOlder)|Soak\.|AudioClock\.Follows'
slow+='|Timestamps\.Any|Tracking\.(AcceptsMore|FaceKeeps|NewSize|DetectionResets|DetectsDiscs|DetectsLess|SearchInterval|TracksA|Loses)|Trained\.[^T]'
slow+='|TrainedLevels\.|Interleavings\.|Trackers\.MayBeCreated|Camera\.|Microphone\.|Clocks\.|FloatState\.ResultsDoNotDependOnDenormals'
slow+='|AudioTrack\.(Accepts|Acts|Fades|Mixes|Replaces|ResultsDoNot)'

scripts/setup.sh build $packages_of
build=build/cross/$target
toolchain=$PWD/scripts/cross/$target.cmake
configure "$build" "$build/googletest" "$toolchain"
build "$build" all mien_shared
if [ "$target" != linux-i386 ]; then  # which has only the tier ref
  scripts/check/symbols.sh "$build" "$nm"
  # Sources that only this machine compiles, without options of gcc that clang lacks or implies.
  mkdir -p "$build/tidy"
  sed 's/ -mfp16-format=ieee//' "$build/compile_commands.json" >"$build/tidy/compile_commands.json"
  scripts/check/tidy.py "$build/tidy" 'kernels/*/neon*.cpp' 'kernels/*/simd.cpp' kernels/detect_cpu.cpp
fi

failed=0
conformance() {  # CPU model, options
  local log=$build/conformance-$1.log
  # shellcheck disable=SC2086  # the emulator is a command with options
  if QEMU_CPU=$1 $emulator "$build/apps/conformance/mien-conformance" --models models "${@:2}" >"$log" 2>&1; then
    echo "$1: $(tail -n 1 "$log"); $(sed -n 's/^mien .*\(tiers: [^;]*\);.*/\1/p' "$log")"
  else
    cat "$log" >&2
    return 1
  fi
}
export -f conformance
export build emulator
echo "== $target: mien-conformance"
tr ' ' '\n' <<<"$models" | xargs -P "$(nproc)" -I MODEL bash -c "conformance MODEL --repeat $seeds" || failed=1
conformance "${models%% *}" --self-test || failed=1

run_tests() {  # CPU model, ctest's choice of tests
  echo "== $target as $1"
  QEMU_CPU=$1 ctest --test-dir "$build" -j "$(nproc)" --output-on-failure --no-tests=error "${@:2}" >"$build/ctest.log" ||
    { failed=1; cat "$build/ctest.log" >&2; }
  grep -E 'tests passed|tests failed|Total Test time' "$build/ctest.log"
}
for model in $models; do
  run_tests "$model" -R 'Golden|PublishedNetworks|HalfSums'
done
# 32-bit x86 needs no emulator, but only has the tier ref, with which one test takes a quarter of an hour.
[ "$target" != linux-i386 ] || slow='TrainedLevels\.ChangingThem'
if [ $full -eq 1 ]; then slow=; else elsewhere+="|$slow"; fi
run_tests "${models%% *}" -E "^(${elsewhere})"

if [ "$target" = linux-arm64 ]; then
  echo "== $target: projects that vendor the library"
  tests/package/vendored_test.sh "$build/package" "fetched embedded" --toolchain "$toolchain" || failed=1
fi

echo "$target: every kernel (mien-conformance, seeds: $seeds), the networks and the engine's golden answers ran as: $models"
echo "$target: the tests of kernels, formats, engine, audio, tracker and the C API ran as: ${models%% *}"
[ -z "$slow" ] || echo "$target: left out (--full has them): $slow"
[ "$target" != linux-arm64 ] || echo "$target: a C project that fetches the library, and one that embeds it, were built and ran (tests/package)"
echo "$target: only compiled: the shared library; not built: the mien program"
exit $failed
