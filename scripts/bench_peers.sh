#!/usr/bin/env bash
# Times mien's networks and the same networks in ONNX Runtime, in turns, one thread each, and writes
# docs/results/peers.md, performance.md and their .json.  usage: scripts/bench_peers.sh [ROUNDS]
# Needs npm (nodejs); makes a Release build unless MIEN_PROGRAM names a program to time.
set -euo pipefail
cd "$(dirname "$0")/.."

rounds=${1:-7}
work=${MIEN_CACHE:-$HOME/.cache/mien}/peers
mkdir -p "$work"

scripts/setup.sh build train
command -v npm >/dev/null || { echo "bench_peers.sh: needs node and npm" >&2; exit 1; }
program=${MIEN_PROGRAM:-build/release/apps/mien/mien}
if [ -z "${MIEN_PROGRAM:-}" ]; then
  cmake --preset release -DMIEN_BUILD_TESTS=OFF >/dev/null
  cmake --build --preset release --target mien_program
fi

scripts/peers/install_onnxruntime.sh
/usr/bin/python3 scripts/peers/export_onnx.py "$work"
cp scripts/peers/onnxruntime_bench.mjs "$work/"

runs=()
for ((round = 0; round < rounds; ++round)); do
  "$program" bench --json >"$work/mien_$round.json"
  "$program" bench --unfused --json >"$work/unfused_$round.json"
  "$program" bench --sound --json >"$work/sound_$round.json"
  "$program" bench --levels tests/data/demo.mp4 --json >"$work/levels_$round.json"
  node "$work/onnxruntime_bench.mjs" "$work" >"$work/peer_$round.json"
  runs+=("$round")
done
/usr/bin/python3 scripts/peers/report.py "$work" "${#runs[@]}" docs/results
/usr/bin/python3 scripts/peers/performance.py "$work" "${#runs[@]}" docs/results
