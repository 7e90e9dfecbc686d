#!/usr/bin/env bash
# usage: gltf_test.sh MIEN_PROGRAM TEST        fetches the packages of TEST (gltf_test.mjs, avatar_test.mjs) and runs it; exit code 77: node or the packages are not available
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
command -v node >/dev/null || { echo "skipped: node is not installed"; exit 77; }
"$here/../../scripts/peers/install_gltf.sh" || { echo "skipped: gltf-validator and three cannot be fetched"; exit 77; }
exec node "$here/$2" "$1" "${MIEN_CACHE:-$HOME/.cache/mien}/gltf"
