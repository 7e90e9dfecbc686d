#!/usr/bin/env bash
# Plants the faults of tests/mutations.txt one by one into a copy of the tree, builds it, and passes the native tests: what they do
# not notice, they do not test. build/mutate/report.md says of each fault which test noticed it first. Built and passed are the tests
# of the fault's own folder first, and those of the folders above only when these did not notice.
# usage: scripts/mutate.sh [--check | FIRST [LAST [STEP]]]     --check: only that every fault still has its place; else by number,
#                                                              default all; STEP 6: every sixth
# Exit status 0 only when every fault was noticed.
set -euo pipefail
cd "$(dirname "$0")/.."
faults=$PWD/tests/mutations.txt
work=$PWD/build/mutate

# plant NUMBER TREE: makes that change there and prints "FILE: the change"; without a tree, says which faults have lost their place.
plant() {
  python3 - "$faults" "$@" <<'PYTHON'
import pathlib, sys
faults = [line.rstrip("\n") for line in open(sys.argv[1]) if line.strip() and not line.startswith("#")]
if len(sys.argv) == 2:
    print(len(faults))
    lost = 0
for number, line in enumerate(faults, 1):
    file, change = line.split(": ", 1)
    before, after = (part.strip(" ").replace("\\n", "\n") for part in change.split("==>"))
    if len(sys.argv) == 2:
        found = pathlib.Path(file).read_text().count(before)
        if found != 1 or before == after:
            print(f"tests/mutations.txt: {line!r}: stands there {found} times", file=sys.stderr)
            lost += 1
    elif number == int(sys.argv[2]):
        path = pathlib.Path(sys.argv[3]) / file
        path.write_text(path.read_text().replace(before, after))
        print(line)
sys.exit(len(sys.argv) == 2 and lost > 0)
PYTHON
}

count=$(plant)
[ "${1:-}" != --check ] || { echo "$count faults, all have their place"; exit 0; }
first=${1:-1} last=${2:-${1:-$count}} step=${3:-1}

. scripts/ccache.sh
tree=$work/source
mkdir -p "$tree"
git ls-files -z | tar --null --files-from=- --create | tar --extract --directory="$tree"
# Without the optimizer's later rounds, which take most of the time that a change takes to build.
cmake -S "$tree" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O1 -DCMAKE_CXX_FLAGS=-O1 -DMIEN_BUILD_APPS=OFF \
  -DMIEN_BUILD_TESTS=ON >/dev/null
declare -A tests=(  # that can see a folder, nearest first
  [kernels]="kernels engine audio tracker api" [formats]="formats engine tracker api" [engine]="engine audio tracker api"
  [audio]="audio tracker api" [tracker]="tracker api" [all]="kernels formats engine audio tracker api")
build() { cmake --build "$work/build" --target "$1/all" -- --quiet >"$work/build.log" 2>&1; }
pass() { ctest --test-dir "$work/build/$1" -j "$(nproc)" --timeout 300 --stop-on-failure >"$work/tests.log" 2>&1; }

# What became of the tree as it is now: who noticed, or nothing.
outcome() {  # folder of the fault
  local part
  for part in ${tests[$1]} realtime fuzz; do
    [ "$part" = fuzz ] || part=tests/$part
    build "$part" || { echo "**nobody could: it does not compile**"; return; }
    pass "$part" || { grep -oE '[0-9]+ - .* \((Failed|Timeout|SEGFAULT|ILLEGAL|Subprocess aborted|.*Exception.*)\)' "$work/tests.log" |
      head -n 1 | sed 's/^[0-9]* - //'; return; }
  done
  echo "**nobody**"
}
sound=$(outcome all)
[ "$sound" = "**nobody**" ] || { cat "$work/build.log" "$work/tests.log" >&2; echo "mutate.sh: without any fault: $sound" >&2; exit 1; }

missed=0
[ "$first" -gt 1 ] || printf '| fault | noticed by |\n|---|---|\n' >"$work/report.md"
for ((number = first; number <= last; number += step)); do
  fault=$(plant "$number" "$tree")
  noticed=$(outcome "${fault%%/*}")
  [[ $noticed != \*\** ]] || missed=$((missed + 1))
  # shellcheck disable=SC2016  # the ticks are Markdown's
  printf '| `%s` | %s |\n' "${fault//|/\\|}" "$noticed" | tee -a "$work/report.md"
  cp "${fault%%: *}" "$tree/${fault%%: *}"
done
echo "$(((last - first) / step + 1)) faults, $missed not noticed"
[ $missed -eq 0 ]
