#!/usr/bin/env bash
# Puts the library where the package compiles it.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
"$here/../../scripts/package/amalgamate.py" -o "$here/Sources/CMien"
