#!/usr/bin/env bash
# Zig's resource compiler with the command line of windres, which CMake expects for gcc and clang.
# usage: MIEN_ZIG=PROGRAM scripts/cross/zig_windres.sh [OPTION...] SOURCE.rc OBJECT
set -euo pipefail
exec "$MIEN_ZIG" rc /fo "${@: -1}" "${@: -2:1}"
