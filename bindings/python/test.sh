#!/usr/bin/env bash
# Builds the wheel and runs the package's tests on it, in a fresh environment of each given Python.
# usage: bindings/python/test.sh [PYTHON]...      default: python3, and the oldest supported one if installed
# The wheel stays in build/python/wheel.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=bindings/python
[ -z "${CI:-}" ] || scripts/setup.sh build python
. scripts/ccache.sh

pythons=("$@")
if [ ${#pythons[@]} -eq 0 ]; then
  pythons=(python3)
  # Asked to run, not only looked for: version managers leave commands that name versions which are not installed.
  if python3.9 -c "import venv" 2>/dev/null; then pythons+=(python3.9); fi
fi
wheels=build/python/wheel
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

rm -rf "$wheels"
"${pythons[0]}" -m venv "$work/build"
"$work/build/bin/pip" install --quiet --quiet --disable-pip-version-check --require-hashes -r scripts/package/wheel_requirements.txt
"$work/build/bin/python" -m build --no-isolation --wheel --outdir "$wheels" "$here" >"$work/build.log" 2>&1 || { cat "$work/build.log" >&2; exit 1; }
wheel=$(echo "$wheels"/mien-*-py3-none-*.whl)
bytes=$(stat -c %s "$wheel")
echo "$(basename "$wheel"): $bytes bytes"
[ "$bytes" -le 6000000 ] || { echo "test.sh: the wheel is larger than 6 MB" >&2; exit 1; }

for python in "${pythons[@]}"; do
  echo "== $("$python" --version)"
  environment=$work/$(basename "$python")
  "$python" -m venv "$environment"
  "$environment/bin/pip" install --quiet --quiet --disable-pip-version-check "$wheel" pytest onnx
  (cd "$here/tests" && "$environment/bin/python" -m pytest -p no:cacheprovider)
  # What the READMEs show, in a folder with a face.mp4.
  mkdir -p "$work/readme"
  ln -sfn "$PWD/tests/data/demo.mp4" "$work/readme/face.mp4"
  tests/docs/code_blocks.py README.md python >"$work/first.py"
  tests/docs/code_blocks.py bindings/python/README.md python >"$work/readme.py"
  (cd "$work/readme" && "$environment/bin/python" "$work/first.py" && "$environment/bin/python" "$work/readme.py") >"$work/readme.txt"
  [ "$(wc -l <"$work/readme.txt")" -gt 480 ]
done

environment=$work/$(basename "${pythons[0]}")
"$environment/bin/pip" install --quiet --quiet --disable-pip-version-check mypy opencv-python-headless matplotlib pandas
(cd "$here/src" && "$environment/bin/mypy" --strict --cache-dir "$work/mypy" --package mien)
"$environment/bin/mypy" --strict --cache-dir "$work/mypy" "$here/tests/typed_program.py"
examples=apps/examples/python
"$environment/bin/python" $examples/webcam.py tests/data/demo.mp4 --frames 20 --save "$work/webcam.png"
test -s "$work/webcam.png"
"$environment/bin/python" $examples/pose_axes.py tests/data/demo.mp4 --frame 150 --save "$work/axes.jpg" | grep -q "yaw 0.[23]"
test -s "$work/axes.jpg"
sed 's|"\.\./\.\./\.\./tests|"tests|' $examples/plot.ipynb |
  "$environment/bin/python" -c 'import json, sys; print("\n".join("".join(c["source"]) for c in json.load(sys.stdin)["cells"] if c["cell_type"] == "code"))' \
    >"$work/plot.py"
MPLBACKEND=agg "$environment/bin/python" "$work/plot.py"
echo "the examples ran"
