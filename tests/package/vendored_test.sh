#!/usr/bin/env bash
# Builds projects that include mien's source, and runs them.
# usage: vendored_test.sh BUILD_FOLDER "PROJECT..." [CMAKE_OPTION]...
#   PROJECT: strict, fetched, embedded. CMAKE_OPTION: for example --toolchain FILE, for another machine
set -euo pipefail
consumers=$(cd "$(dirname "$0")" && pwd)
mien=$(cd "$consumers/../.." && pwd)
version=$(sed -n 's/^project(mien VERSION \([0-9.]*\).*/\1/p' "$mien/CMakeLists.txt")

for project in $2; do
  echo "== $project"
  cmake -S "$consumers/$project" -B "$1/$project" -G Ninja -DCMAKE_BUILD_TYPE=Release -DMIEN_SOURCE="$mien" \
    -DMIEN_EXPECTED_VERSION="$version" "${@:3}" >/dev/null
  cmake --build "$1/$project" -- --quiet
  ctest --test-dir "$1/$project" --output-on-failure --no-tests=error
done

[ -d "$1/embedded" ] || exit 0
echo "== no file system, and no excluded parts"
library=$(find "$1/embedded" -name libmien.a)
if nm -A "$library" | grep -E ' U f?(open|read|write|close)(at|64|v)?$|[^a-z]printf$|avx512|AudioNet|Resampler'; then
  exit 1
fi
strip -o "$1/stripped" "$1/embedded/embedded" 2>/dev/null || cp "$1/embedded/embedded" "$1/stripped"  # for another machine
bytes=$(stat -c %s "$1/stripped")
echo "a program of level 1 with its weights: $bytes bytes"
# The limit in docs/packages.md; clang's code is 33 KB larger.
if [ "$(uname -m) $#" = "x86_64 2" ] && [[ $("${CC:-cc}" --version) != *clang* ]] && [ "$bytes" -gt 1610000 ]; then
  echo "vendored_test.sh: too large (got $bytes bytes, expected at most 1610000)" >&2
  exit 1
fi
