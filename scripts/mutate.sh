#!/usr/bin/env bash
# Mutation testing: changes single lines of tracker/, audio/, engine/, formats/, apps/animation/ and apps/protocols/ with
# universalmutator, builds each mutant, and runs the nearest tests until one fails. A surviving mutant shows behaviour
# that no test checks.
# usage: scripts/mutate.sh [--count N] [--seed S] [--workers W] [--again] [--only FILE...] [--report]      --help explains them
# Continues an interrupted run, whose results are in build/mutate/results.jsonl. Exit status 0 only if tests kill 95 %.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test
. scripts/ccache.sh
python=build/mutate/python
[ -x $python/bin/python ] || /usr/bin/python3 -m venv --system-site-packages $python
$python/bin/python -c 'import universalmutator' 2>/dev/null ||
  $python/bin/pip install --quiet --disable-pip-version-check universalmutator==1.14.1
PYTHONPATH=tests exec $python/bin/python -m mutation "$@"
