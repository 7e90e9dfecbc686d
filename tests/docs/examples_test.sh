#!/usr/bin/env bash
# Runs the commands of apps/examples/README.md, which compile the library again, and tests the programs that they build.
# usage: tests/docs/examples_test.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/ccache.sh
rm -rf build/examples build/mien
bash -euo pipefail <(tests/docs/code_blocks.py apps/examples/README.md sh)
python3 tests/apps/examples_test.py build/examples/jaw_open_c build/examples/jaw_open_cpp
