#!/usr/bin/env bash
# Replays the fuzzing corpora under clang's memory sanitizer, which ends a program where a number that nobody wrote decides anything:
# readers and writers of files, kernels on every tier of this machine, networks, and trackers with picture and sound.
# Debian's C++ library knows nothing of it. What of that library is a template is compiled with the targets; the few other functions
# that they call and that write memory are in fuzz/cxx_library.cpp. Left out are the tests, since GoogleTest prints by many more of
# them, and curves_csv, whose refusals are exceptions.
# usage: scripts/msan.sh
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test
. scripts/ccache.sh

cmake --preset msan >/dev/null
mapfile -t targets < <(ctest --test-dir build/msan/fuzz --show-only | sed -n 's/.*: fuzz_replay_//p' | grep -vx curves_csv)
cmake --build --preset msan --target "${targets[@]/#/replay_}"
names=$(IFS='|'; echo "${targets[*]}")

# It has to notice, before its silence counts.
fault=build/msan/fault
echo 'int main(int count, char** words) { int numbers[9]; if (numbers[count + (words == 0)] > 7) { return 0; } return 0; }' |
  clang -fsanitize=memory -x c - -o $fault
if $fault 2>/dev/null; then
  echo "msan.sh: it does not notice a number that nobody wrote" >&2
  exit 1
fi
ctest --test-dir build/msan/fuzz -R "^fuzz_replay_($names)\$" -j "$(nproc)" --output-on-failure --no-tests=error
