#!/usr/bin/env bash
# Builds and tests for every other machine (docs/cross.md), as many at a time as there are processors. What ran is said at the
# end of each; all that it printed is in build/cross/logs.
# usage: scripts/cross/all.sh [--full]      --full: more seeds, targets and tests, and hours
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build test cross-x86 cross-arm cross-s390x cross-wasm cross-windows cross-compile-only cross-musl
mkdir -p build/cross/logs

run() {  # script of this folder, its arguments
  local log=build/cross/logs/${*// /_}.log code=0 output
  scripts/cross/"$1" "${@:2}" >"$log" 2>&1 || code=$?
  if [ $code -eq 0 ]; then
    output=$(grep -E '^(linux|wasm|windows|compile)[a-z0-9-]*[:,] ' "$log")  # what ran: "linux-arm64: ..."
    printf '== %s: right, %d s\n%s\n' "$*" $SECONDS "$output"
  else
    printf '== %s: FAILED (%d), %d s\n%s\n' "$*" $code $SECONDS "$(<"$log")"
    return 1
  fi
}
export -f run

xargs -P "$(nproc)" -I LINE bash -c "run LINE $*" <<'LINES'
test.sh linux-arm64
test.sh linux-armv7
wasm.sh
windows.sh
compile_only.sh
linux_x64.sh
big_endian.sh
musl.sh
LINES
