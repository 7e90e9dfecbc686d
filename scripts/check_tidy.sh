#!/usr/bin/env bash
# clang-tidy over the library and the programs. usage: scripts/check_tidy.sh BUILD_DIR
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:?build directory with compile_commands.json}
git ls-files 'kernels/*.cpp' 'formats/*.cpp' 'engine/*.cpp' 'tracker/*.cpp' 'apps/*.cpp' |
  xargs -r -P "$(nproc)" -n 4 clang-tidy -p "$build" --quiet
