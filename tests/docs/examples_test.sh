#!/usr/bin/env bash
# Runs the commands of apps/examples/README.md, which compile the library again, and tests the programs that they build. Follows the README
# for the program and C++.
# usage: tests/docs/examples_test.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/ccache.sh
rm -rf build/examples build/mien build/examples-project
bash -euo pipefail <(tests/docs/code_blocks.py apps/examples/README.md sh 1)
python3 tests/apps/examples_test.py build/examples/jaw_open_c build/examples/jaw_open_cpp

project=build/examples-project
mkdir -p $project/{app,build}
ln -s "$PWD/build/mien" $project/build/mien
ln -s "$PWD/tests/data/demo.mp4" $project/face.mp4
tests/docs/code_blocks.py apps/examples/README.md c >$project/app/app.c
tests/docs/code_blocks.py apps/examples/README.md cmake >$project/app/CMakeLists.txt
commands=$(tests/docs/code_blocks.py apps/examples/README.md sh 2)
[ "$(cd $project && bash -euo pipefail -c "$commands" | grep -c "jawOpen [01][.][0-9]")" -eq 240 ]

tests/docs/paths_test.py program cpp
