#!/usr/bin/env bash
# Runs all functions that real-time threads may call under clang's real-time sanitizer, which detects functions of the C
# library that may block. Requires clang 20.
# usage: scripts/rtsan.sh
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build test rtsan
. scripts/ccache.sh
cmake --preset rtsan >/dev/null
cmake --build --preset rtsan --target realtime_sanitizer_test
build/rtsan/tests/realtime/realtime_sanitizer_test
