#!/usr/bin/env bash
# Checks that a build for a big-endian machine (s390x) fails with a clear message; see docs/cross.md.
# usage: scripts/cross/big_endian.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh cross-s390x
refusal="mien requires a little-endian machine"

compile() {  # compiler, file
  "$1" -std=c++20 -fno-exceptions -fno-rtti -fsyntax-only -I. -Iinclude "$2" 2>&1
}
# All sources that read weight files. They compile for little-endian machines, so byte order is the only reason for the error.
for file in formats/mien_open.cpp formats/mien_writer.cpp engine/model.cpp tracker/tracker.cpp; do
  compile g++ $file || { echo "big_endian.sh: $file does not compile for this machine either" >&2; exit 1; }
  if messages=$(compile s390x-linux-gnu-g++ $file); then
    echo "big_endian.sh: $file compiles for s390x, where its results would be wrong" >&2
    exit 1
  fi
  grep -qF "$refusal" <<<"$messages" || { echo "big_endian.sh: $file: another error: $messages" >&2; exit 1; }
done
echo "linux-s390x: compilation fails as intended: $refusal"
