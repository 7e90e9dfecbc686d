#!/usr/bin/env bash
# Follows a binding's README: saves its program, runs its commands in a copy of the repository, and expects 30 rows of results.
# usage: bindings/readme_test.sh BINDING LANGUAGE FILE      FILE: the README's name of the program
set -euo pipefail
cd "$(dirname "$0")/.."
readme=bindings/$1/README.md
work=$PWD/build/readme/$1  # kept, so that the library is not compiled again the next time
mkdir -p "$work"
export CCACHE_BASEDIR=$work

for name in *; do
  [ "$name" = build ] || ln -sfn "$PWD/$name" "$work/$name"
done
ln -sfn "$PWD/tests/data/demo.mp4" "$work/face.mp4"
rm -rf "$work"/example "$work"/face.rgb "$work"/build/*/face.rgb
if [ "$1" = rust ]; then
  (cd "$work" && cargo new --quiet --vcs none example && sed -i '/^\[dependencies\]/d' example/Cargo.toml)
  tests/docs/code_blocks.py bindings/rust/README.md toml >>"$work/example/Cargo.toml"
fi
tests/docs/code_blocks.py "$readme" "$2" >"$work/$3"
tests/docs/code_blocks.py "$readme" sh >"$work/commands.sh"
(cd "$work" && bash -euo pipefail commands.sh) >"$work/output" 2>&1 </dev/null || { cat "$work/output" >&2; exit 1; }
if [ "$(grep -cE '^[01][.,][0-9]{2} ' "$work/output")" -ne 30 ]; then
  cat "$work/output" >&2
  echo "readme_test.sh: $readme: wrong output (expected 30 rows)" >&2
  exit 1
fi
echo "the commands of $readme ran"
