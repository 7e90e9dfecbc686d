#!/usr/bin/env bash
# With a Swift toolchain: builds the package, and runs its tests and the README's example. Otherwise clang imports its module, and a message lists the untested rest.
# usage: bindings/swift/test.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
bindings/swift/prepare.sh
if command -v swift >/dev/null && swift --version >/dev/null 2>&1; then
  . bindings/library.sh
  (cd bindings/swift && swift test -c release --scratch-path ../../build/bindings/swift)
  built=build/bindings/swift/release/Modules
  [ "$(uname)" = Darwin ] || swiftc -emit-module -parse-as-library -module-name AVFoundation -emit-module-path "$built/AVFoundation.swiftmodule" \
    bindings/swift/Tests/Declarations/AVFoundation.swift
  swiftc -typecheck -I "$built" -I bindings/swift/Sources/CMien bindings/swift/Examples/CameraFace.swift
  exec tests/docs/paths_test.py swift
fi
if ! command -v clang >/dev/null; then
  echo "NOT TESTED: bindings/swift: neither Swift nor clang is installed (scripts/setup.sh test)"
  exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/import.m" <<'IMPORT'
@import CMien;
_Static_assert(sizeof(mien_result) > sizeof(float) * 2 * MIEN_LANDMARK_COUNT, "the header is there");
mien_status (*create)(const mien_tracker_config*, mien_tracker**, mien_error_detail*) = mien_tracker_create;
IMPORT
clang -fmodules -fmodules-cache-path="$work/cache" -fmodule-map-file=bindings/swift/Sources/CMien/module.modulemap -Werror -Wall -Wextra -fsyntax-only \
  "$work/import.m"
echo "clang imports CMien"
# Every function that Swift calls is declared in the header.
grep -rhoE '\bmien_[a-z_]+\(' bindings/swift/Sources/Mien | sort -u | while read -r call; do
  grep -qF "$call" include/mien/mien.h || [[ "$call" =~ ^mien_(image|audio|tracker_config|weights_config|error_detail|result|status)\($ ]] || { echo "no $call in mien.h" >&2; exit 1; }
done
echo "NOT TESTED: the Swift of bindings/swift, for which there is no compiler (scripts/cross/swift.sh)"
