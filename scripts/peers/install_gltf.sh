#!/usr/bin/env bash
# Fetches Khronos' glTF validator and three.js from npm, for the tests apps.gltf and apps.avatar, into ${MIEN_CACHE:-~/.cache/mien}/gltf.
# usage: scripts/peers/install_gltf.sh        Needs npm (nodejs).
set -euo pipefail
exec "$(dirname "$0")/npm_packages.sh" gltf gltf-validator@2.0.0-dev.3.10 three@0.187
