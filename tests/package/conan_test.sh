#!/usr/bin/env bash
# Makes the Conan package, and a consumer of it in C, with Conan from PyPI. It compiles the library once more.
# usage: tests/package/conan_test.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/ccache.sh
work=$PWD/build/conan
mkdir -p "$work"
python3 -m venv "$work/python"
if ! "$work/python/bin/pip" install --quiet --quiet --disable-pip-version-check "conan>=2,<3"; then
  echo "NOT TESTED: the Conan recipe, since Conan could not be had from PyPI"
  exit 0
fi
export CONAN_HOME=$work/home
"$work/python/bin/conan" profile detect --force >/dev/null
"$work/python/bin/conan" create scripts/package/conan --no-remote --build=missing -s compiler.cppstd=20 -c tools.build:jobs=2 \
  -c tools.cmake.cmake_layout:test_folder="$work/consumer"
