#!/usr/bin/env bash
# Installs the peers of bench.sh from PyPI into ${MIEN_CACHE:-~/.cache/mien}/peers/venv. Packages that cannot be installed are reported.
# usage: scripts/peers/install_python.sh
set -euo pipefail
venv=${MIEN_CACHE:-$HOME/.cache/mien}/peers/venv
[ -x "$venv/bin/pip" ] || /usr/bin/python3 -m venv "$venv"

peer() {  # options and packages of pip
  "$venv/bin/pip" install --quiet --disable-pip-version-check "$@" || echo "NOT MEASURED: $* cannot be installed" >&2
}
peer numpy==2.4.6 onnxruntime==1.32.0 onnx==1.23.2
peer openvino==2026.4.1
peer nncf==3.4.0 ai-edge-quantizer==0.10.0
peer --no-deps ncnn==1.0.20261020 pnnx==20261020  # neither needs the PyTorch and OpenCV that it names
peer ai-edge-litert==2.3.0
peer mediapipe==1.2.2
peer --no-deps silero-vad==6.2.3  # for the network in it
