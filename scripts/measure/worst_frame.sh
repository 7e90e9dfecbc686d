#!/usr/bin/env bash
# Times the slowest frames while a face disappears and returns -> docs/results/worst_frame.md
# usage: scripts/measure/worst_frame.sh [ROUNDS]     of 300 frames; default 20
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/ccache.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --preset release >/dev/null
cmake --build --preset release --target mien_worst_frame >/dev/null
ffmpeg -v error -i tests/data/demo.mp4 -vf scale=640:480 -pix_fmt nv12 -f rawvideo "$work/frames"
{
  cat <<'TEXT'
# The worst frame

For developers with a time limit per frame.

`scripts/measure/worst_frame.sh` compares the slowest frame in a thousand (p99.9) with the median; the goal is a ratio of 3 at most. The data are the demo clip at 640 x 480, in a loop,
with 60 of 300 frames without a face. Times are CPU time of the thread, the minimum of five runs, without the first frame.

TEXT
  build/release/tests/tracker/frame_bench/mien_worst_frame models "$work/frames" 640 480 "${1:-20}"
} >"$work/report"
cp "$work/report" docs/results/worst_frame.md
