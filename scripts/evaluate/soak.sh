#!/usr/bin/env bash
# Hours of pictures and sound, from devices whose clocks differ and that lose blocks, faster than they pass -> docs/results/soak.md
# usage: scripts/evaluate/soak.sh [HOURS]     (default: 8)
set -euo pipefail
cd "$(dirname "$0")/../.."
hours=${1:-8}

cmake --preset release >/dev/null
cmake --build --preset release --target mien_soak >/dev/null
{
  cat <<'TEXT'
# Hours of picture and sound

Frames at 30 a second; sound in blocks of 10 ms from a device whose clock is off, with timestamps that tremble by 3 ms, gaps of 0.03 to
3 s about every 41 s, and another rate (8, 16, 44.1 or 48 kHz) about every 97 s. The sound swells and fades every 1.37 s; measured is
when the frames show that, against when it was, from one second after a gap or a change on. Bar: never more than 20 ms; memory flat.

Made by `scripts/evaluate/soak.sh`.

| clock, parts in a million | hours | frames | with a face | gaps | changes of rate | measured | mean error, ms | largest, ms | resident after a tenth, MiB | at the end |
|---|---|---|---|---|---|---|---|---|---|---|
TEXT
  build/release/tests/tracker/mien_soak "$hours"
} | tee docs/results/soak.md
