#!/usr/bin/env bash
# Checks that an #include refers only to folders that docs/architecture.md allows. Standard headers are exempt.
set -euo pipefail
cd "$(dirname "$0")/../.."

declare -A MAY_INCLUDE=(
  [include]="mien"
  [kernels]="kernels"
  [formats]="formats mien"
  [engine]="engine kernels formats mien"
  [audio]="audio engine kernels formats mien"
  [tracker]="tracker engine audio kernels formats mien"
  [apps]="apps mien formats"
  [apps/conformance]="apps kernels formats mien"   # runs single kernels
)

bad=0
for folder in "${!MAY_INCLUDE[@]}"; do
  [ -d "$folder" ] || continue
  while IFS=: read -r file line text; do
    # apps/conformance and apps/mien/bench have their own rules.
    [ "$folder" != apps ] || [[ "$file" != apps/conformance/* && "$file" != apps/mien/bench/* ]] || continue
    target=$(sed -E 's/.*#include[[:space:]]*["<]([^">]+)[">].*/\1/' <<<"$text")
    top=${target%%/*}
    case "$text" in *'<'*'>'*) [[ "$target" == */* && -d "$top" ]] || [[ "$top" == mien ]] || continue ;; esac
    if ! grep -qw -- "$top" <<<"${MAY_INCLUDE[$folder]}"; then
      echo "$file:$line: $folder/ must not include $target" >&2
      bad=1
    fi
  done < <(grep -rnE '^[[:space:]]*#include' "$folder" --include='*.h' --include='*.hpp' --include='*.cpp' --include='*.inc' --include='*.S' || true)
done
exit $bad
