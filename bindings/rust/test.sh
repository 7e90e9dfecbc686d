#!/usr/bin/env bash
# Passes the crates' tests and runs the README's example, offline.
# usage: bindings/rust/test.sh      (CARGO: default cargo; scripts/setup.sh build rust)
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo=${CARGO:-cargo}
if ! "$cargo" --version 2>/dev/null; then
  echo "NOT TESTED: bindings/rust, for which there is no cargo (scripts/setup.sh rust)"
  exit 0
fi
. bindings/library.sh
export CARGO_TARGET_DIR=$PWD/build/bindings/rust RUSTFLAGS="-D warnings" RUSTDOCFLAGS="-D warnings"
(cd bindings/rust && "$cargo" test --offline --locked --quiet)
CARGO_NET_OFFLINE=true tests/docs/paths_test.py rust
