#!/usr/bin/env bash
# A minute of all that a real-time thread may call, under clang's real-time sanitizer: no function of the C library that may block.
# clang has it since version 20.
# usage: scripts/rtsan.sh
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test rtsan
. scripts/ccache.sh
cmake --preset rtsan >/dev/null
cmake --build --preset rtsan --target realtime_sanitizer_test
build/rtsan/tests/realtime/realtime_sanitizer_test
