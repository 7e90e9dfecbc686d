#!/usr/bin/env bash
# Simulates hours of video and audio from devices with different clocks and lost blocks -> docs/results/soak.md
# usage: scripts/measure/soak.sh [HOURS]     default 24: 2.6 million frames, 5.4 million audio steps
# Exit status 0 only if all checks pass. Every test run simulates a minute (Soak.AudioAndVideoStaySynchronized).
set -euo pipefail
cd "$(dirname "$0")/../.."
hours=${1:-24}
. scripts/ccache.sh

cmake --preset release >/dev/null
cmake --build --preset release --target mien_soak >/dev/null
began=$SECONDS code=0
table=$(build/release/tests/tracker/mien_soak "$hours") || code=$?
{
  cat <<TEXT
# Soak test

For developers who run mien for days.

The table has the results of $hours hours of video and audio, simulated in $((SECONDS - began)) s. Video has 30 frames per second, and a face that
disappears for 4 s every 100 s. Audio comes in blocks of 10 ms from a device with an inaccurate clock, with 3 ms of timestamp jitter, gaps of 0.03
to 3 s about every 41 s, and a new sample rate (8, 16, 44.1 or 48 kHz) about every 97 s. The loudness has a period of 1.37 s; the test compares the
time at which frames show it with the true time, from one second after a gap or change on. The networks are small ones that detect discs, so
times (CPU time) differ from those of the trained networks ([worst frame](worst_frame.md)). Memory, ids and times count from a tenth of the hours on.

Made by \`scripts/measure/soak.sh $hours\`.

$table
TEXT
} | tee docs/results/soak.md
exit $code
