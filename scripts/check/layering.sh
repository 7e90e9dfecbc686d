#!/usr/bin/env bash
# An #include may only point down the house: see docs/architecture.md. Standard headers are free.
set -euo pipefail
cd "$(dirname "$0")/../.."

declare -A MAY_INCLUDE=(
  [include]="mien"
  [kernels]="kernels"
  [formats]="formats"
  [engine]="engine kernels formats mien"
  [audio]="audio engine kernels formats mien"
  [tracker]="tracker engine audio kernels formats mien"
  [apps]="apps mien formats"
  [apps/conformance]="apps kernels formats mien"   # checks kernels one by one
)

bad=0
for room in "${!MAY_INCLUDE[@]}"; do
  [ -d "$room" ] || continue
  while IFS=: read -r file line text; do
    # A room inside a room has rules of its own.
    [ "$room" != apps ] || [[ "$file" != apps/conformance/* ]] || continue
    target=$(sed -E 's/.*#include[[:space:]]*["<]([^">]+)[">].*/\1/' <<<"$text")
    top=${target%%/*}
    case "$text" in *'<'*'>'*) [[ "$target" == */* && -d "$top" ]] || [[ "$top" == mien ]] || continue ;; esac
    if ! grep -qw -- "$top" <<<"${MAY_INCLUDE[$room]}"; then
      echo "$file:$line: $room/ must not include $target" >&2
      bad=1
    fi
  done < <(grep -rnE '^[[:space:]]*#include' "$room" --include='*.h' --include='*.hpp' --include='*.cpp' --include='*.inc' --include='*.S' || true)
done
exit $bad
