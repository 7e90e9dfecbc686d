#!/usr/bin/env bash
# What a frame costs at worst, while a face goes and comes back -> docs/results/worst_frame.md
# usage: scripts/evaluate/worst_frame.sh [ROUNDS]     of 300 frames; default 20
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

The demo clip, 640 x 480: followed for 240 frames, then upside down for 60, again and again. Time that the thread had a processor. On the
very first frame, which is left out, a search is done at once. All of it five times over, the least time of each frame. Bar: the slowest
frame in a thousand takes 3 times the median at most. [reliability.md](../reliability.md#real-time) says where the time goes.

Made by `scripts/evaluate/worst_frame.sh`.

TEXT
  build/release/tests/tracker/frame_bench/mien_worst_frame models "$work/frames" 640 480 "${1:-20}"
} >"$work/report"
cp "$work/report" docs/results/worst_frame.md
