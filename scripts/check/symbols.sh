#!/usr/bin/env bash
# Tier files leak nothing: every global symbol of an ISA tier's objects is one of its kernels, nothing is weak (an inline
# function that the linker could merge with everybody else's), and nothing runs before main.
# usage: scripts/check/symbols.sh BUILD_DIR [NM]     NM: reads objects of another machine; default nm
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:?build directory}
nm=${2:-nm}

bad=0
objects=$(find "$build/kernels" -path '*mien_kernels_*' ! -path '*mien_kernels_ref*' -name '*.o')
[ -n "$objects" ] || { echo "check/symbols.sh: no tier objects in $build" >&2; exit 1; }
for object in $objects; do
  tier=$(sed -E 's|.*mien_kernels_([a-z0-9]+)\.dir.*|\1|' <<<"$object")
  # T: a function of its own. Anything else global and defined is a leak.
  leaks=$("$nm" --defined-only --demangle "$object" | awk '$2 ~ /[A-Z]/ && $2 != "N"' |
    grep -vE " T mien::kernels::$tier::[a-z_0-9]+\(" | grep -vE ' [WV] DW\.ref' || true)
  if [ -n "$leaks" ]; then
    echo "$object leaks:" >&2
    echo "$leaks" >&2
    bad=1
  fi
done

# The library as a whole: no static initialisers, and only the public names leave it.
library=$(find "$build" -name 'libmien.a' | head -1)
if [ -n "$library" ] && "$nm" "$library" 2>/dev/null | grep '_GLOBAL__sub_I' >/dev/null; then
  echo "$library runs code before main" >&2
  bad=1
fi
exit $bad
