#!/usr/bin/env bash
# Prints the history of the benchmarks: microseconds of each network and tier in the commits of docs/results/performance.json (written by
# scripts/peers/bench.sh), oldest first, as CSV. Peaks in GFLOP/s show whether the machine changed.
# usage: scripts/measure/bench_history.sh [COMMITS]      default: the last 20
set -euo pipefail
cd "$(dirname "$0")/../.."
echo commit,date,peak_gflops,network,tier,min_us
git log --reverse --format='%h %as' -n "${1:-20}" -- docs/results/performance.json | while read -r commit day; do
  git show "$commit:docs/results/performance.json" | python3 -c 'import json, sys
page = json.load(sys.stdin)
for row in page["networks"]:
    print(sys.argv[1], round(page["peak_gflops"][row["tier"]]), row["network"], row["tier"], round(row["min_us"], 3), sep=",")' "$commit,$day"
done
