#!/usr/bin/env bash
# Lints Python with ruff (rules: scripts/pyproject.toml) and limits the size of scripts/.
# usage: scripts/check/python.sh [--fix]
set -euo pipefail
cd "$(dirname "$0")/../.."
CHECKED=(scripts tests/blender tests/convert tests/mutation tests/train apps/blender apps/conformance apps/convert apps/examples fuzz)
LINES=16500  # of code in scripts/; lower it when the code shrinks

scripts/check/code_size.py "$LINES"
scripts/check/python_statements.py "${CHECKED[@]}"
python=build/ruff/bin/python
[ -x $python ] || python3 -m venv build/ruff
if ! $python -m pip install --quiet --disable-pip-version-check -r scripts/check/ruff_requirements.txt; then
  echo "SKIPPED: Python: ruff could not be installed from PyPI" >&2
  exit 0
fi
ruff=(build/ruff/bin/ruff check --config scripts/pyproject.toml --no-cache)
# A check that accepts an unused import does not work.
if printf 'import os\n' | "${ruff[@]}" --quiet - >/dev/null; then
  echo "check/python.sh: an unused import is not reported" >&2
  exit 1
fi
"${ruff[@]}" "$@" "${CHECKED[@]}"
