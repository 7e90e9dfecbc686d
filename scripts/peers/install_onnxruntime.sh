#!/usr/bin/env bash
# Fetches ONNX Runtime from npm, for the test convert.onnx, into ${MIEN_CACHE:-~/.cache/mien}/peers.
# usage: scripts/peers/install_onnxruntime.sh        Needs npm (nodejs).
set -euo pipefail
ONNXRUNTIME_NODE_INSTALL=skip exec "$(dirname "$0")/npm_packages.sh" peers onnxruntime-node@1.30
