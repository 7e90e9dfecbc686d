#!/usr/bin/env bash
# Fetches Khronos' glTF validator and three.js from npm, for the test apps.gltf, into ${MIEN_CACHE:-~/.cache/mien}/gltf.
# usage: scripts/peers/install_gltf.sh        Needs npm (nodejs).
set -euo pipefail
work=${MIEN_CACHE:-$HOME/.cache/mien}/gltf
mkdir -p "$work"
if [ ! -d "$work/node_modules/gltf-validator" ] || [ ! -d "$work/node_modules/three" ]; then
  command -v npm >/dev/null || { echo "install_gltf.sh: needs node and npm" >&2; exit 1; }
  (cd "$work" && npm install --ignore-scripts --no-audit --no-fund gltf-validator@2.0.0-dev.3.10 three@0.187)
fi
