#!/usr/bin/env bash
# How much of the library its tests run: clang counts lines and branches while the native tests pass and the fuzzing corpora are
# replayed. docs/results/coverage.md takes the table; build/coverage/uncovered.txt names every line and branch that nothing ran.
# usage: scripts/coverage.sh      Exit status 0 only when the bars are met (scripts/coverage_report.py).
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test coverage
. scripts/ccache.sh

build=build/coverage
parts=(tests/{kernels,formats,engine,audio,tracker,realtime,api} fuzz)
cmake --preset coverage >/dev/null
cmake --build --preset coverage --target "${parts[@]/%//all}"

rm -rf $build/profiles
export LLVM_PROFILE_FILE=$PWD/$build/profiles/%m.profraw  # one for each program, whoever runs it
for part in "${parts[@]}"; do  # without what does the same thousands of times, and the size of stacks
  ctest --test-dir "$build/$part" -E 'Interleavings|MayBeMade|Stack' -j "$(nproc)" --timeout 1800 --output-on-failure --no-tests=error >"$build/ctest.log" || { cat "$build/ctest.log"; exit 1; }
  echo "$part: $(grep 'tests passed' "$build/ctest.log")"
done
llvm-profdata merge --sparse $build/profiles/*.profraw -o $build/tests.profdata

mapfile -t programs < <(find $build/tests $build/fuzz -type f -executable ! -name '*.so' ! -name '*.cmake')
llvm-cov export -instr-profile=$build/tests.profdata "${programs[0]}" "${programs[@]/#/-object=}" >$build/export.json
python3 scripts/coverage_report.py $build/export.json $build/uncovered.txt docs/results/coverage.md
