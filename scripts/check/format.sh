#!/usr/bin/env bash
# Checks the formatting of C and C++ with clang-format (.clang-format). usage: scripts/check/format.sh [--fix]
set -euo pipefail
cd "$(dirname "$0")/../.."
mode=(--dry-run --Werror)
[ "${1:-}" != "--fix" ] || mode=(-i)
git ls-files '*.h' '*.hpp' '*.cpp' '*.c' | xargs -r clang-format "${mode[@]}"
