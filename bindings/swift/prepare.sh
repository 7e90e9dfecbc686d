#!/usr/bin/env bash
# Copies the library to the folder in which the package compiles it.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
"$here/../../scripts/package/amalgamate.py" -o "$here/Sources/CMien"
