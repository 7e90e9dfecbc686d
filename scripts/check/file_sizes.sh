#!/usr/bin/env bash
# Checks that no source file exceeds 450 lines, except mien.h: users read the whole C API in one header.
# usage: scripts/check/file_sizes.sh
set -euo pipefail
cd "$(dirname "$0")/../.."

SOURCES=('*.h' '*.hpp' '*.inc' '*.c' '*.cpp' '*.S' '*.py' '*.sh' '*.js' '*.mjs' '*.ts' '*.cs' '*.java' '*.kt' '*.rs' '*.swift' '*.cmake' '*CMakeLists.txt')
git ls-files -z "${SOURCES[@]}" :!include/mien/mien.h | xargs -0 wc -l | awk '$1 > 450 && $2 != "total" { print $2 ": too long (got " $1 " lines, expected at most 450)"; long = 1 }
  END { exit long }' >&2
