#!/usr/bin/env bash
# Builds mien and tracks the clip that ships with it: curves as CSV, an overlay video, a summary, and the error
# against the clip's true controls.  usage: scripts/demo.sh [OUT_DIR]      (default: out)
set -euo pipefail
cd "$(dirname "$0")/.."

out=${1:-out}
scripts/setup.sh build demo
mkdir -p "$out"

cmake --preset release -DMIEN_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target mien_program

build/release/apps/mien/mien track tests/data/demo.mp4 -o "$out/demo.csv" --landmarks "$out/demo_landmarks.csv" \
  --overlay "$out/demo.mp4" --stats "$out/demo_stats.json"
python3 scripts/measure/compare_truth.py "$out/demo.csv" tests/data/demo_truth.csv
echo "curves: $out/demo.csv   landmarks: $out/demo_landmarks.csv   video: $out/demo.mp4"
echo "to run mien from any folder in this shell: export PATH=\"$PWD/build/release/apps/mien:\$PATH\""
