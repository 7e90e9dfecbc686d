#!/usr/bin/env bash
# Lints Python with ruff (rules: scripts/check/ruff.toml) and limits the size of scripts/ and models/training/.
# usage: scripts/check/python.sh [--fix]
set -euo pipefail
cd "$(dirname "$0")/../.."
CHECKED=(scripts models/training tests/blender tests/convert tests/mutation tests/train apps/blender apps/conformance apps/convert apps/examples fuzz)

# Lines of code; lower these limits when the code shrinks.
scripts/check/code_size.py scripts 5000
scripts/check/code_size.py models/training 12000
scripts/check/python_statements.py "${CHECKED[@]}"
python=build/ruff/bin/python
[ -x $python ] || python3 -m venv build/ruff
if ! $python -m pip install --quiet --disable-pip-version-check -r scripts/check/ruff_requirements.txt; then
  echo "SKIPPED: Python: ruff could not be installed from PyPI" >&2
  exit 0
fi
ruff=(build/ruff/bin/ruff check --config scripts/check/ruff.toml --no-cache)
# A check that accepts an unused import does not work.
if printf 'import os\n' | "${ruff[@]}" --quiet - >/dev/null; then
  echo "check/python.sh: an unused import is not reported" >&2
  exit 1
fi
"${ruff[@]}" "$@" "${CHECKED[@]}"
