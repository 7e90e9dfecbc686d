#!/usr/bin/env bash
# Fetches ONNX's tests of single nodes from its Python package into ${MIEN_CACHE:-~/.cache/mien}, for the test convert.nodes.
# usage: tests/convert/fetch_node_tests.sh      Needs pip and unzip. The last version whose opset (18) the converter takes.
set -euo pipefail
version=1.13.1
folder=${MIEN_CACHE:-$HOME/.cache/mien}/onnx-node-tests-$version
[ ! -d "$folder" ] || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Uses the package for any Python and machine: the tests are the same in all of them.
/usr/bin/python3 -m pip download --quiet --no-deps --only-binary=:all: --python-version 3.11 --platform manylinux2014_x86_64 \
  --dest "$work" "onnx==$version"
unzip -q "$work"/onnx-*.whl 'onnx/backend/test/data/node/*' -d "$work"
mkdir -p "$(dirname "$folder")"
mv "$work/onnx/backend/test/data/node" "$folder"
