#!/usr/bin/env bash
# Checks that tier objects define no symbols but their kernels: no other global symbols, no weak ones (inline functions
# that the linker could merge with those of other objects), and no code that runs before main.
# usage: scripts/check/symbols.sh BUILD_DIR [NM]     NM: for objects of another machine; default nm
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:?build directory}
nm=${2:-nm}

bad=0
objects=$(find "$build/kernels" -path '*mien_kernels_*' ! -path '*mien_kernels_ref*' -name '*.o')
[ -n "$objects" ] || { echo "check/symbols.sh: no tier objects in $build" >&2; exit 1; }
for object in $objects; do
  tier=$(sed -E 's|.*mien_kernels_([a-z0-9]+)\.dir.*|\1|' <<<"$object")
  # T is a function. Any other global definition is an error.
  leaks=$("$nm" --defined-only --demangle "$object" | awk '$2 ~ /[A-Z]/ && $2 != "N"' |
    grep -vE " T mien::kernels::$tier::[a-z_0-9]+\(" | grep -vE ' [WV] DW\.ref' || true)
  if [ -n "$leaks" ]; then
    echo "$object: unexpected symbols:" >&2
    echo "$leaks" >&2
    bad=1
  fi
done

# The whole library has no static initializers.
library=$(find "$build" -name 'libmien.a' | head -1)
if [ -n "$library" ] && "$nm" "$library" 2>/dev/null | grep '_GLOBAL__sub_I' >/dev/null; then
  echo "$library runs code before main" >&2
  bad=1
fi
exit $bad
