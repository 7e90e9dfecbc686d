#!/usr/bin/env bash
# Runs the Release program under valgrind's memcheck, which sees what compilers made of the sources: numbers that nobody wrote and that
# decide something, memory that is not theirs, and what was not given back. It has no AVX-512: the tiers are those of a CPU with AVX2.
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
# Long straight lines of AVX2 with origins to track overflow what memcheck has for one piece of them, unless pieces are short.
check() { valgrind --quiet --vex-guest-max-insns=20 --error-exitcode=99 --track-origins=yes --leak-check=full --child-silent-after-fork=yes "$@"; }

# It has to notice, before its silence counts.
echo 'int main(int count, char** words) { int numbers[9]; return numbers[count + (words == 0)] > 7 ? 1 : 2; }' | cc -w -O0 -x c - -o "$work/fault"
code=0
check "$work/fault" 2>/dev/null || code=$?
[ $code -eq 99 ] || { echo "valgrind.sh: it does not notice a number that nobody wrote" >&2; exit 1; }

program=build/release/apps/mien/mien
check $program inspect models/basenet.mien >/dev/null
for level in 1 4; do
  check $program track tests/data/demo.mp4 --quiet --duration "$seconds" --lod $level -o "$work/curves.csv" -o "$work/face.glb" \
    --landmarks "$work/landmarks.csv"
done
echo "valgrind: no errors at levels 1 and 4 on $seconds s of the demo clip, by picture and sound, nor in mien inspect"
