#!/usr/bin/env bash
# Plants the faults of tests/mutations.txt one by one into a copy of the tree, builds the test programs nearest to each, and runs
# them until the first test fails: what they do not notice, they do not test. build/mutate/report.md says of each which test it was.
# usage: scripts/mutate.sh [--check | FIRST [LAST [STEP]]]     --check: only that every fault still has its place; else by number,
#                                                              default all; STEP 6: every sixth
# Exit status 0 only when every fault was noticed.
set -euo pipefail
cd "$(dirname "$0")/.."
faults=$PWD/tests/mutations.txt
work=$PWD/build/mutate

# Whose tests are to notice a folder's faults, the ones that are done first first.
declare -A programs=(
  [kernels]="kernels_test" [formats]="formats_test" [engine]="engine_test" [audio]="audio_test tracker_test"
  [tracker]="tracker_geometry_test api_test tracker_threads_test tracker_test")

# plant NUMBER TREE: makes that change there and prints "FILE: the change"; without a tree, says which faults have lost their place.
plant() {
  python3 - "$faults" "$@" <<'PYTHON'
import pathlib, sys
faults = [line.rstrip("\n") for line in open(sys.argv[1]) if line.strip() and not line.startswith("#")]
if len(sys.argv) == 2:
    print(len(faults))
    lost = 0
for number, line in enumerate(faults, 1):
    file, change = line.split(": ", 1)
    before, after = (part.strip(" ").replace("\\n", "\n") for part in change.split("==>"))
    if len(sys.argv) == 2:
        found = pathlib.Path(file).read_text().count(before)
        if found != 1 or before == after:
            print(f"tests/mutations.txt: {line!r}: stands there {found} times", file=sys.stderr)
            lost += 1
    elif number == int(sys.argv[2]):
        path = pathlib.Path(sys.argv[3]) / file
        path.write_text(path.read_text().replace(before, after))
        print(line)
sys.exit(len(sys.argv) == 2 and lost > 0)
PYTHON
}

count=$(plant)
[ "${1:-}" != --check ] || { echo "$count faults, all have their place"; exit 0; }
first=${1:-1} last=${2:-${1:-$count}} step=${3:-1}

. scripts/ccache.sh
tree=$work/source
mkdir -p "$tree"
git ls-files -z | while IFS= read -r -d '' file; do  # what differs alone, and as new: a fault that was left there is compiled out
  cmp --silent "$file" "$tree/$file" || cp --parents "$file" "$tree"
done
# Without the optimizer's later rounds and the kernels for AVX-512, which take most of the time that a change takes to build (no fault is in
# these kernels); and without a list of every program's tests, which nobody reads here.
cmake -S "$tree" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O1 -DCMAKE_CXX_FLAGS=-O1 -DMIEN_BUILD_APPS=OFF \
  -DMIEN_BUILD_TESTS=ON -DMIEN_WITH_AVX512=OFF -DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST >/dev/null

# Runs a program's tests in shards, as many at a time as there are processors and none after one that failed, and prints the first
# test that did.
passes() {  # program
  local shard failed
  rm -f "$work"/shard.*
  export program="$work/build/tests/*/$1" work
  # shellcheck disable=SC2016  # the inner shell's
  seq 0 7 | xargs -P "$(nproc)" -n 1 bash -c \
    'GTEST_TOTAL_SHARDS=8 GTEST_SHARD_INDEX=$0 timeout 300 $program --gtest_fail_fast >"$work/shard.$0" 2>&1 || exit 255' 2>/dev/null && return
  # shellcheck disable=SC2016  # the ticks are Markdown's
  failed=$(sed -nE 's/^\[  FAILED  \] ([^ ,]*).* \(.* ms\)$/`\1`/p' "$work"/shard.* | head -n 1)
  # shellcheck disable=SC2016
  for shard in "$work"/shard.*; do  # one that did not come to its end stopped in the last test that it began
    [ -n "$failed" ] || grep -q '^\[==========\].* ran\.' "$shard" ||
      failed="$(sed -n 's/^\[ RUN      \] \(.*\)/`\1`/p' "$shard" | tail -n 1) (it crashes, or does not end)"
  done
  echo "$failed"
  return 1
}

# What became of the tree as it is now: which test noticed, or nobody.
outcome() {  # programs
  local program
  for program in "$@"; do
    cmake --build "$work/build" --target "$program" -- --quiet >"$work/build.log" 2>&1 || { echo "**nobody could: it does not compile**"; return; }
    passes "$program" || return 0
  done
  echo "**nobody**"
}

# shellcheck disable=SC2046  # words
sound=$(outcome $(tr ' ' '\n' <<<"${programs[*]}" | sort -u))
[ "$sound" = "**nobody**" ] || { cat "$work/build.log" "$work"/shard.* >&2; echo "mutate.sh: without any fault: $sound" >&2; exit 1; }

missed=0
[ "$first" -gt 1 ] || printf '| fault | noticed by |\n|---|---|\n' >"$work/report.md"
for ((number = first; number <= last; number += step)); do
  fault=$(plant "$number" "$tree")
  # shellcheck disable=SC2086  # words
  noticed=$(outcome ${programs[${fault%%/*}]})
  [[ $noticed != \*\** ]] || missed=$((missed + 1))
  # shellcheck disable=SC2016  # the ticks are Markdown's
  printf '| `%s` | %s |\n' "${fault//|/\\|}" "$noticed" | tee -a "$work/report.md"
  cp "${fault%%: *}" "$tree/${fault%%: *}"
done
times >"$work/times"  # the second line: of all that was started, user and system
echo "$(((last - first) / step + 1)) faults, $missed not noticed; processor time $(tail -n 1 "$work/times")"
[ $missed -eq 0 ]
