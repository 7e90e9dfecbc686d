#!/usr/bin/env bash
# Builds the Conan package and a consumer in C, with Conan from PyPI. Compiles the library again.
# usage: tests/package/conan_test.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/ccache.sh
work=$PWD/build/conan
mkdir -p "$work"
python3 -m venv "$work/python"
if ! "$work/python/bin/pip" install --quiet --quiet --disable-pip-version-check "conan>=2,<3"; then
  echo "NOT TESTED: the Conan recipe: Conan could not be installed from PyPI"
  exit 0
fi
export CONAN_HOME=$work/home
"$work/python/bin/conan" profile detect --force >/dev/null
"$work/python/bin/conan" create scripts/package/conan --no-remote --build=missing -s compiler.cppstd=20 -c tools.build:jobs=2 \
  -c tools.cmake.cmake_layout:test_folder="$work/consumer"
