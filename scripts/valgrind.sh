#!/usr/bin/env bash
# Runs the Release program under valgrind's memcheck, which detects the use of uninitialized memory, invalid accesses
# and leaks in optimized code. It does not support AVX-512, so the tiers are those of a CPU with AVX2.
# usage: scripts/valgrind.sh [SECONDS]      of the demo clip, default 1
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-1}
scripts/setup.sh build test valgrind
. scripts/ccache.sh

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --preset release >/dev/null
cmake --build --preset release --target mien_program -- --quiet
# Long blocks of AVX2 code with tracked origins exceed a limit of memcheck, so blocks are kept short.
check() { valgrind --quiet --vex-guest-max-insns=20 --error-exitcode=99 --track-origins=yes --leak-check=full --child-silent-after-fork=yes "$@"; }

# Checks that it detects the use of uninitialized memory.
echo 'int main(int count, char** words) { int numbers[9]; return numbers[count + (words == 0)] > 7 ? 1 : 2; }' | cc -w -O0 -x c - -o "$work/fault"
code=0
check "$work/fault" 2>/dev/null || code=$?
[ $code -eq 99 ] || { echo "valgrind.sh: the use of uninitialized memory is not detected" >&2; exit 1; }

program=build/release/apps/mien/mien
check $program inspect models/basenet.mien >/dev/null
for level in 1 4; do
  check $program track tests/data/demo.mp4 --quiet --duration "$seconds" --lod $level -o "$work/curves.csv" -o "$work/face.glb" \
    --landmarks "$work/landmarks.csv"
done
echo "valgrind: no errors at levels 1 and 4 on $seconds s of the demo clip, with video and audio, and in mien inspect"
