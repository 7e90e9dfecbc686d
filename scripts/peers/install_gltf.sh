#!/usr/bin/env bash
# Fetches Khronos' glTF validator and three.js from npm, for the tests apps.gltf and apps.avatar, into ${MIEN_CACHE:-~/.cache/mien}/gltf.
# usage: scripts/peers/install_gltf.sh        Needs npm (nodejs).
set -euo pipefail
work=${MIEN_CACHE:-$HOME/.cache/mien}/gltf
mkdir -p "$work"
if [ ! -f "$work/node_modules/.package-lock.json" ]; then  # npm writes it last: without it, an install was interrupted
  command -v npm >/dev/null || { echo "install_gltf.sh: needs node and npm" >&2; exit 1; }
  rm -rf "$work/node_modules"
  (cd "$work" && npm install --ignore-scripts --no-audit --no-fund gltf-validator@2.0.0-dev.3.10 three@0.187)
fi
