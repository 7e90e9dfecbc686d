#!/usr/bin/env bash
# Tests the add-on in Blender's Python module (bpy), which is installed from PyPI into build/bpy: 350 MB for each version.
# usage: tests/blender/bpy_test.sh MIEN_PROGRAM [BPY_VERSION]...      default: the oldest version supported, and the newest tested
# Exit status 77: bpy cannot be installed.
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../.."
versions=("${@:2}")
[ ${#versions[@]} -gt 0 ] || versions=(4.2.23 5.0.1)

skip() {
  echo "SKIPPED: the Blender add-on is NOT TESTED in Blender: $1" >&2
  exit 77
}
command -v node >/dev/null || skip "node, which writes the avatar, is missing"
python=$(command -v python3.11) || skip "Python 3.11, which bpy needs, is missing"

apps/blender/package.sh
node tests/blender/avatar_glb.mjs build/blender/avatar.glb
for version in "${versions[@]}"; do
  environment=build/bpy/$version
  if ! "$environment/bin/python" -c "import bpy" 2>/dev/null; then
    "$python" -m venv --clear "$environment"
    "$environment/bin/pip" install --quiet --disable-pip-version-check "bpy==$version" || skip "bpy $version cannot be installed from PyPI"
  fi
  echo "== Blender $version"
  validator=$(find "$environment" -path '*/bl_pkg/cli/blender_ext.py')  # what blender --command extension validate runs
  "$environment/bin/python" "$validator" validate build/blender/mien_face.zip
  "$environment/bin/python" tests/blender/in_blender_test.py "$program" "$PWD" build/blender/mien_face.zip build/blender/avatar.glb
  "$environment/bin/python" tests/blender/program_avatar_test.py "$program" "$PWD"
done
