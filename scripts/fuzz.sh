#!/usr/bin/env bash
# Fuzzes every target under the address and undefined-behaviour sanitizers, and prints the number of runs of each. New
# inputs are stored in build/fuzz/found/NAME for the next run. Inputs that fail are stored in fuzz/corpus/NAME, so that
# every bug becomes a test.
# Exit status 0 only if no input failed.
# usage: scripts/fuzz.sh [--jobs N] [--tally] [MINUTES [TARGET...]]      total minutes, default 2
#   --jobs N   number of concurrent targets, default the number of processors
#   --tally    adds runs and processor time to docs/results/fuzzing.json and updates the table of fuzzing.md
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc) tally=
while [[ "${1:-}" == --* ]]; do
  case $1 in
    --jobs) jobs=$2; shift 2 ;;
    --tally) tally=docs/results/fuzzing; shift ;;
    *) echo "fuzz.sh: unknown option '$1'" >&2; exit 2 ;;
  esac
done
minutes=${1:-2}
shift || true
scripts/setup.sh build test
. scripts/ccache.sh

cmake --preset fuzz >/dev/null
# Prevents concurrent runs from writing the same logs, including processes that a killed run has left.
exec {lock}>build/fuzz/lock
flock --nonblock "$lock" || { echo "fuzz.sh: another run, or a process of one, uses build/fuzz" >&2; exit 1; }
list=build/fuzz/fuzz/targets.txt
[ $# -gt 0 ] || mapfile -t all < <(cut -d' ' -f1 $list)
[ $# -gt 0 ] || set -- "${all[@]}"
cmake --build --preset fuzz --target "${@/#/fuzz_}"

seconds=$((minutes * 60 * jobs / $#))
[ $seconds -gt 5 ] || seconds=5
fuzz() {  # TARGET
  local found=build/fuzz/found/$1 log=build/fuzz/found/$1.log options=() folders code=0 runs used TIMEFORMAT='%U %S'
  mkdir -p "$found" "fuzz/corpus/$1"
  IFS=';' read -ra folders <<<"$(grep "^$1 " $list | cut -d' ' -f2)"
  [ ! -f "fuzz/dictionaries/$1.dict" ] || options+=("-dict=fuzz/dictionaries/$1.dict")
  # The limit per input is wall-clock time, and high because the machine may be busy.
  { time build/fuzz/fuzz/"fuzz_$1" -max_total_time=$seconds -max_len="$(max_length "$1")" -timeout=300 -report_slow_units=300 \
    -rss_limit_mb=3000 -print_final_stats=1 -artifact_prefix="fuzz/corpus/$1/" "${options[@]}" "$found" "${folders[@]}" \
    >"$log" 2>&1; } 2>"$log.time" || code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  used=$(tail -n 1 "$log.time")
  printf '%-20s %10s runs, %5s inputs%s\n' "$1" "$runs" "$(find "$found" -type f | wc -l)" "$([ $code -eq 0 ] || echo "  BROKEN: $log")"
  [ -z "$tally" ] || flock "$list" scripts/fuzz_tally.py $tally.json $tally.md "$1" "${runs:-0}" "$used"
  return $code
}
max_length() {  # TARGET: the length of golden files and of the corpus; short for sequences of choices
  case $1 in
    weight_file*) echo 20000 ;;
    animation) echo 8192 ;;
    curves_csv | wav | y4m | pnm | npy | neutral_file | packed_file) echo 4096 ;;
    *) echo 400 ;;
  esac
}
export -f fuzz max_length
export seconds list tally
printf '%s\n' "$@" | xargs -P "$jobs" -I NAME bash -c 'fuzz NAME'
