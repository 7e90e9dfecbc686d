#!/usr/bin/env bash
# Fuzzes every target, under the address and undefined-behaviour sanitizers, and says for each how often it ran. What they find new
# stays in build/fuzz/found/NAME for the next time; what broke one is put to fuzz/corpus/NAME, since every bug found becomes a test.
# Exit status 0 only when nothing broke.
# usage: scripts/fuzz.sh [--jobs N] [--tally] [MINUTES [TARGET...]]      minutes in all, default 2
#   --jobs N   so many targets at a time, default as many as there are processors
#   --tally    adds runs and processor time to docs/results/fuzzing.json and makes the table of fuzzing.md of them
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
# What a killed run leaves going holds it, too, so that no two runs write the same logs.
exec {lock}>build/fuzz/lock
flock --nonblock "$lock" || { echo "fuzz.sh: another run, or what one left going, has build/fuzz" >&2; exit 1; }
list=build/fuzz/fuzz/targets.txt
[ $# -gt 0 ] || mapfile -t all < <(cut -d' ' -f1 $list)
[ $# -gt 0 ] || set -- "${all[@]}"
cmake --build --preset fuzz --target "${@/#/fuzz_}"

seconds=$((minutes * 60 * jobs / $#))
[ $seconds -gt 5 ] || seconds=5
fuzz() {  # target
  local found=build/fuzz/found/$1 log=build/fuzz/found/$1.log options=() folders code=0 runs used TIMEFORMAT='%U %S'
  mkdir -p "$found" "fuzz/corpus/$1"
  IFS=';' read -ra folders <<<"$(grep "^$1 " $list | cut -d' ' -f2)"
  [ ! -f "fuzz/dictionaries/$1.dict" ] || options+=("-dict=fuzz/dictionaries/$1.dict")
  # The limit of an input's time is one of the clock, and generous, since the machine may have other work.
  { time build/fuzz/fuzz/"fuzz_$1" -max_total_time=$seconds -max_len="$(max_length "$1")" -timeout=300 -report_slow_units=300 \
    -rss_limit_mb=3000 -print_final_stats=1 -artifact_prefix="fuzz/corpus/$1/" "${options[@]}" "$found" "${folders[@]}" \
    >"$log" 2>&1; } 2>"$log.time" || code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  used=$(tail -n 1 "$log.time")
  printf '%-20s %10s runs, %5s inputs%s\n' "$1" "$runs" "$(find "$found" -type f | wc -l)" "$([ $code -eq 0 ] || echo "  BROKEN: $log")"
  [ -z "$tally" ] || flock "$list" scripts/fuzz_tally.py $tally.json $tally.md "$1" "${runs:-0}" "$used"
  return $code
}
max_length() {  # target: files are as long as the golden ones and those of the corpus, choices of calls short
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
