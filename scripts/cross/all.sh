#!/usr/bin/env bash
# Builds and tests for every other machine (docs/cross.md), one per processor at a time. Prints a summary of
# each; build/cross/logs has the whole output.
# usage: scripts/cross/all.sh [--full] [NAME...]
#   --full   more seeds, targets and tests, and hours
#   NAME     of a machine: arm64, armv7, wasm, windows, compile_only, linux_x64, big_endian, musl, zig; default all
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build test cross-x86 cross-arm cross-s390x cross-wasm cross-windows cross-compile-only cross-musl cross-zig

# The longest first.
declare -A of=([arm64]="test.sh linux-arm64" [armv7]="test.sh linux-armv7")
names=(arm64 armv7 wasm windows compile_only linux_x64 big_endian musl zig)
for name in "${names[@]:2}"; do of[$name]=$name.sh; done
options=()
[ "${1:-}" != --full ] || { options=(--full); shift; }
[ $# -eq 0 ] || names=("$@")
for name in "${names[@]}"; do
  [ -n "${of[$name]:-}" ] || { echo "all.sh: unknown machine '$name'" >&2; exit 2; }
done
mkdir -p build/cross/logs

run() {  # script of this folder, its arguments
  local log=build/cross/logs/${*// /_}.log code=0 output
  scripts/cross/"$1" "${@:2}" >"$log" 2>&1 || code=$?
  if [ $code -eq 0 ]; then
    output=$(grep -E '^(linux|macos|wasm|windows|compile)[a-z0-9-]*[:,] ' "$log")  # what ran: "linux-arm64: ..."
    printf '== %s: right, %d s\n%s\n' "$*" $SECONDS "$output"
  else
    printf '== %s: FAILED (%d), %d s\n%s\n' "$*" $code $SECONDS "$(<"$log")"
    return 1
  fi
}
export -f run

for name in "${names[@]}"; do echo "${of[$name]}"; done | xargs -P "$(nproc)" -I LINE bash -c "run LINE ${options[*]}"
