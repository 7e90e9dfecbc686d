#!/usr/bin/env bash
# Fetches ONNX Runtime from npm, for the test convert.onnx, into ${MIEN_CACHE:-~/.cache/mien}/peers.
# usage: scripts/peers/install_onnxruntime.sh        Needs npm (nodejs).
set -euo pipefail
work=${MIEN_CACHE:-$HOME/.cache/mien}/peers
mkdir -p "$work"
if [ ! -d "$work/node_modules/onnxruntime-node" ]; then
  command -v npm >/dev/null || { echo "install_onnxruntime.sh: needs node and npm" >&2; exit 1; }
  (cd "$work" && ONNXRUNTIME_NODE_INSTALL=skip npm install --ignore-scripts --no-audit --no-fund onnxruntime-node@1.30)
fi
