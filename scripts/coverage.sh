#!/usr/bin/env bash
# Measures test coverage of the library: clang counts lines and branches during the native tests and the replay of the
# fuzzing corpora. Writes the table of docs/results/coverage.md, and every uncovered line and branch to
# build/coverage/uncovered.txt.
# usage: scripts/coverage.sh      Exit status 0 only if the minimums are reached (scripts/coverage_report.py).
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test coverage
. scripts/ccache.sh

build=build/coverage
parts=(tests/{kernels,formats,engine,audio,tracker,realtime,api,apps/animation,apps/protocols} fuzz)
cmake --preset coverage >/dev/null
cmake --build --preset coverage --target "${parts[@]/%//all}"

rm -rf $build/profiles
export LLVM_PROFILE_FILE=$PWD/$build/profiles/%m.profraw  # one file per program
for part in "${parts[@]}"; do  # excludes tests with thousands of repetitions, and of stack sizes
  ctest --test-dir "$build/$part" -E 'Interleavings|MayBeMade|Stack' -j "$(nproc)" --timeout 1800 --output-on-failure --no-tests=error >"$build/ctest.log" || { cat "$build/ctest.log"; exit 1; }
  echo "$part: $(grep 'tests passed' "$build/ctest.log")"
done
llvm-profdata merge --sparse $build/profiles/*.profraw -o $build/tests.profdata

mapfile -t programs < <(find $build/tests $build/fuzz -type f -executable ! -name '*.so' ! -name '*.cmake')
llvm-cov export -instr-profile=$build/tests.profdata "${programs[0]}" "${programs[@]/#/-object=}" >$build/export.json
python3 scripts/coverage_report.py $build/export.json $build/uncovered.txt docs/results/coverage.md
