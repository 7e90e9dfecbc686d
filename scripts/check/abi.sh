#!/usr/bin/env bash
# Compares the shared library's binary interface with that of the last release (tests/package/abi/libmien.abi, written with its tag):
# programs compiled with that release must still work. Additions pass, and so do members in the place of reserved ones. Before the first
# release nothing is compared; the check then only proves that it detects a change.
# usage: scripts/check/abi.sh [--update]      --update: writes the description of the current interface, for a release
set -euo pipefail
cd "$(dirname "$0")/../.."
baseline=tests/package/abi/libmien.abi
build=build/abi

[ "$(uname -m)" = x86_64 ] || { echo "NOT CHECKED: the binary interface, whose description is of x86-64"; exit 0; }
. scripts/ccache.sh
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DMIEN_BUILD_TESTS=OFF -DMIEN_BUILD_APPS=OFF -DMIEN_BUILD_CONFORMANCE=OFF >/dev/null
cmake --build "$build" --target mien_shared -- --quiet
library=$(readlink -f "$build/tracker/libmien.so")

describe() {  # file: the interface of today's library
  abidw --headers-dir include --drop-private-types --exported-interfaces-only --no-corpus-path --no-comp-dir-path --no-show-locs \
    --out-file "$1" "$library"
}
if [ "${1:-}" = --update ]; then
  describe "$baseline"
  exit 0
fi
describe "$build/now.abi"
released=1
if [ ! -s "$baseline" ]; then
  if git tag --list | grep -qx 'v0\.1\.0'; then
    echo "check/abi.sh: $baseline: missing, although v0.1.0 is released (--update at that tag writes it)" >&2
    exit 1
  fi
  released=0
  baseline=$build/now.abi
fi

breaks() {  # old interface: prints the differences; succeeds if they break programs
  local report code=0
  report=$(abidiff --leaf-changes-only "$1" "$build/now.abi") || code=$?
  echo "$report"
  # Bits: 1 and 2 are errors of abidiff, 4 a change, 8 a removal.
  [ $((code & 11)) -ne 0 ] ||
    grep -E "^ *'.*' (offset|type|name) changed|^ *type '.*' of '|^  type size changed|deletion|[1-9][0-9]* (Removed|Changed)" \
      <<<"$report" | grep -qv "::reserved' changed:"
}

# Checks that it detects a member of a struct that moved.
moved=$build/moved.abi
awk "/class-decl name='mien_result'/ { inside = 1 } inside && /data-member/ && ++n == 3 { sub(/layout-offset-in-bits='[0-9]+'/, \"layout-offset-in-bits='96'\") } /<\/class-decl>/ { inside = 0 } { print }" \
  "$baseline" >"$moved"
if cmp -s "$baseline" "$moved" || ! breaks "$moved" >/dev/null; then
  echo "check/abi.sh: a moved member of mien_result was not noticed" >&2
  exit 1
fi

if [ "$released" = 0 ]; then
  echo "NOT COMPARED: the binary interface, because there is no release yet (tag v0.1.0)"
  exit 0
fi
if breaks "$baseline"; then
  echo "check/abi.sh: programs that were compiled with the last release would break" >&2
  exit 1
fi
echo "check/abi.sh: programs of the last release run with this library"
