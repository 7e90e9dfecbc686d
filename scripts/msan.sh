#!/usr/bin/env bash
# Replays the fuzzing corpora of the readers under clang's memory sanitizer, which ends a program where a number that nobody wrote decides anything.
# Debian's C++ library knows nothing of it: what is a template there, strings above all, is compiled with the targets
# (_GLIBCXX_EXTERN_TEMPLATE=0); what is not, such as std::to_chars of floating-point numbers, writes what the sanitizer does not see
# written. So animations, which are written with it, are left out, and the tests, for GoogleTest's sake.
# usage: scripts/msan.sh
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test
. scripts/ccache.sh

targets=(weight_file weight_file_fields neutral_file npy pnm wav y4m csv_row)
cmake --preset msan >/dev/null
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
