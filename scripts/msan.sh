#!/usr/bin/env bash
# Replays the fuzzing corpora under clang's memory sanitizer, which detects the use of uninitialized memory: readers and
# writers of files, kernels of every tier of this machine, networks, and trackers with video and audio. Debian's C++
# library is not instrumented. Its templates are compiled with the targets; fuzz/cxx_library.cpp wraps the few other
# functions that write memory. Excludes the tests, because GoogleTest uses many more of these functions, and curves_csv,
# which uses exceptions.
# usage: scripts/msan.sh
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test
. scripts/ccache.sh

cmake --preset msan >/dev/null
mapfile -t targets < <(ctest --test-dir build/msan/fuzz --show-only | sed -n 's/.*: fuzz_replay_//p' | grep -vx curves_csv)
cmake --build --preset msan --target "${targets[@]/#/replay_}"
names=$(IFS='|'; echo "${targets[*]}")

# Checks that it detects the use of uninitialized memory.
fault=build/msan/fault
echo 'int main(int count, char** words) { int numbers[9]; if (numbers[count + (words == 0)] > 7) { return 0; } return 0; }' |
  clang -fsanitize=memory -x c - -o $fault
if $fault 2>/dev/null; then
  echo "msan.sh: the use of uninitialized memory is not detected" >&2
  exit 1
fi
ctest --test-dir build/msan/fuzz -R "^fuzz_replay_($names)\$" -j "$(nproc)" --output-on-failure --no-tests=error
