#!/usr/bin/env bash
# clang-tidy, as .clang-tidy says. usage: scripts/check_tidy.sh BUILD_DIR [FOLDER|PATTERN.cpp...]
# Without any, what people run: the library and the programs. The tests include GoogleTest, which takes ten
# seconds a file, so they are checked when named: scripts/check_tidy.sh build/clang tests fuzz
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:?build directory with compile_commands.json}
shift
[ $# -gt 0 ] || set -- kernels formats engine audio tracker apps
patterns=()
for name in "$@"; do
  [[ $name == *.cpp ]] || name+='/*.cpp'
  patterns+=("$name")
done

# What is no part of the build, such as the kernels for another CPU, cannot be checked.
built() {
  while read -r file; do
    ! grep -qF "/$file\"" "$build/compile_commands.json" || echo "$file"
  done
}
git ls-files -- "${patterns[@]}" | built |
  xargs -r -P "$(nproc)" -n 1 clang-tidy -p "$build" --quiet 2> >(grep -v ' warnings\? generated' >&2 || true)
