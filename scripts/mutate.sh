#!/usr/bin/env bash
# Mutation testing: changes single lines of tracker/, audio/, engine/, formats/, apps/animation/ and apps/protocols/ as universalmutator proposes, builds each mutant,
# and runs the nearest tests until one fails. A mutant that survives shows behaviour that no test checks.
# usage: scripts/mutate.sh [--count N] [--seed S] [--workers W] [--again] [--only FILE...] [--report]      --help: what these are
# A run that was stopped goes on where it was: results are in build/mutate/results.jsonl. Exit status 0 only when 95 % were killed.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test
. scripts/ccache.sh
python=build/mutate/python
[ -x $python/bin/python ] || /usr/bin/python3 -m venv --system-site-packages $python
$python/bin/python -c 'import universalmutator' 2>/dev/null ||
  $python/bin/pip install --quiet --disable-pip-version-check universalmutator==1.14.1
PYTHONPATH=scripts exec $python/bin/python -m mutation "$@"
