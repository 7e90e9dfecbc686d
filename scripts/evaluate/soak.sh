#!/usr/bin/env bash
# Hours of picture and sound, from devices whose clocks differ and that lose blocks, faster than they pass -> docs/results/soak.md
# usage: scripts/evaluate/soak.sh [HOURS]     default 24: 2.6 million frames, 5.4 million steps of sound
# Exit status 0 only when all is as it must be. A minute of it is Soak.PictureAndSoundStayTogether, of every test run.
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
# Hours of picture and sound

$hours hours, in $((SECONDS - began)) s. Frames at 30 a second, every 100 s a face that goes for 4 s and comes back; sound in blocks of 10 ms from
a device whose clock is off, with timestamps that tremble by 3 ms, gaps of 0.03 to 3 s about every 41 s, and another rate (8, 16, 44.1 or
48 kHz) about every 97 s. The sound swells and fades every 1.37 s; measured is when the frames show that, against when it was, from one
second after a gap or a change on. The networks are those of the tests, which know discs: times are no times of the trained ones
([worst_frame.md](worst_frame.md)), and processor time. Memory, ids and times from a tenth of the hours on.

Made by \`scripts/evaluate/soak.sh $hours\`.

$table
TEXT
} | tee docs/results/soak.md
exit $code
