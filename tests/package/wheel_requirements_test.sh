#!/usr/bin/env bash
# Checks that building the wheel without a compiler or a library fails with their names.
# usage: tests/package/wheel_requirements_test.sh BIN      BIN: the folder of a Python with the packages of wheel_requirements.txt
set -euo pipefail
bin=$(cd "$1" && pwd)
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/tools"
for tool in cmake ninja sh uname; do
  ln -s "$(command -v $tool)" "$work/tools"
done

fails_with() {  # text, environment and command
  if "${@:2}" >"$work/output" 2>&1; then
    echo "wheel_requirements_test.sh: the wheel was built" >&2
    exit 1
  fi
  grep -qF "$1" "$work/output" || { cat "$work/output" >&2; exit 1; }
}
build=("$bin/python" -m build --no-isolation --wheel --outdir "$work" bindings/python)
fails_with "C++ compiler: missing (expected in PATH: " env -u CC -u CXX PATH="$work/tools" "${build[@]}" "-Cbuild-dir=$work/first"
grep -qF "apt install g++" "$work/output"
fails_with "libraries: missing (CLI11)" "${build[@]}" -Ccmake.define.CMAKE_DISABLE_FIND_PACKAGE_CLI11=ON "-Cbuild-dir=$work/second"
echo "the build of the wheel names missing tools and libraries"
