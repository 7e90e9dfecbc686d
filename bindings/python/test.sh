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
  # Runs it, because version managers leave commands for versions that are not installed.
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
"$work/build/bin/python" scripts/package/shrink_wheel.py "$wheel"
bytes=$(stat -c %s "$wheel")
echo "$(basename "$wheel"): $bytes bytes"
[ "$bytes" -le 5000000 ] || { echo "test.sh: the wheel is larger than 5 MB" >&2; exit 1; }

tests/package/wheel_requirements_test.sh "$work/build/bin"

mkdir "$work/readme"  # a folder in which the code of the pages runs
ln -s "$PWD/tests/data/demo.mp4" "$work/readme/face.mp4"
ffmpeg -v error -ss 4 -i tests/data/demo.mp4 -frames:v 1 "$work/readme/face.jpg"
run_blocks() {  # environment, page, language, numbers
  for number in "${@:4}"; do
    tests/docs/code_blocks.py "$2" "$3" "$number" >"$work/block.py"
    (cd "$work/readme" && "$1/bin/python" "$work/block.py")
  done
}

for python in "${pythons[@]}"; do
  echo "== $("$python" --version)"
  environment=$work/$(basename "$python")
  "$python" -m venv "$environment"
  "$environment/bin/pip" install --quiet --quiet --disable-pip-version-check "$wheel" pytest onnx
  (cd "$here/tests" && "$environment/bin/python" -m pytest -p no:cacheprovider)
  {
    run_blocks "$environment" README.md python 1
    run_blocks "$environment" bindings/python/README.md python 1 3
  } >"$work/readme.txt"
  [ "$(wc -l <"$work/readme.txt")" -eq 480 ]
done

environment=$work/$(basename "${pythons[0]}")
"$environment/bin/pip" install --quiet --quiet --disable-pip-version-check mypy pyright opencv-python-headless matplotlib pandas
(cd "$here/src" && "$environment/bin/mypy" --strict --cache-dir "$work/mypy" --package mien)
check_types() {  # command of a type checker: passes a right program, and reports each mistake of a wrong one
  "$@" "$here/tests/typed_program.py"
  "$@" "$here/tests/wrongly_typed_program.py" >"$work/types.txt" || true
  diff <(grep -n "# error" "$here/tests/wrongly_typed_program.py" | cut -d: -f1) <(sed -nE 's/.*\.py:([0-9]+):.* error:.*/\1/p' "$work/types.txt" | sort -nu)
}
check_types "$environment/bin/mypy" --strict --cache-dir "$work/mypy"
if "$environment/bin/pyright" --version >/dev/null 2>&1; then
  check_types "$environment/bin/pyright" --pythonpath "$environment/bin/python"
else
  echo "NOT TESTED: types with pyright, which could not be installed from npm"
fi

(cd "$here/tests" && "$environment/bin/python" -m pytest -p no:cacheprovider test_draw.py) | tee "$work/draw.txt"
grep -q "^4 passed" "$work/draw.txt"
run_blocks "$environment" bindings/python/README.md python 2 | grep "^0\.[3-6]" >/dev/null
test -s "$work/readme/drawn.png"
# Block 1 is MediaPipe's program, whose model and package are not installed here.
run_blocks "$environment" docs/mediapipe.md python 2 3 >"$work/mediapipe.txt"
[ "$(grep -c "^0\.[0-9]" "$work/mediapipe.txt")" -gt 200 ]
examples=apps/examples/python
"$environment/bin/python" $examples/jaw_open.py "$work/readme/face.jpg" | grep "^jawOpen 0\.[3-6]" >/dev/null
"$environment/bin/python" $examples/webcam.py tests/data/demo.mp4 --frames 20 --save "$work/webcam.png"
test -s "$work/webcam.png"
"$environment/bin/python" $examples/pose_axes.py tests/data/demo.mp4 --frame 150 --save "$work/axes.jpg" | grep "yaw 0.[23]" >/dev/null
test -s "$work/axes.jpg"
sed 's|"\.\./\.\./\.\./tests|"tests|' $examples/plot.ipynb |
  "$environment/bin/python" -c 'import json, sys; print("\n".join("".join(c["source"]) for c in json.load(sys.stdin)["cells"] if c["cell_type"] == "code"))' \
    >"$work/plot.py"
MPLBACKEND=agg "$environment/bin/python" "$work/plot.py"
echo "the examples ran"
tests/docs/paths_test.py python
