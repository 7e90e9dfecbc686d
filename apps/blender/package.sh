#!/usr/bin/env bash
# Makes the zip that Blender installs, with the same bytes every time.
# usage: apps/blender/package.sh [ZIP]      default: build/blender/mien_face.zip
set -euo pipefail
cd "$(dirname "$0")/../.."
zip=${1:-build/blender/mien_face.zip}

apps/blender/generate_vocabularies.py --check
version=$(sed -n 's/^project(mien VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
grep -qx "version = \"$version\"" apps/blender/mien_face/blender_manifest.toml || {
  echo "package.sh: version: blender_manifest.toml does not have mien's ($version)" >&2
  exit 1
}

mkdir -p "$(dirname "$zip")"
python3 - "$zip" <<'PYTHON'
import sys
import zipfile
from pathlib import Path

source = Path("apps/blender/mien_face")
files = {path.name: path for path in (*source.glob("*.py"), source / "blender_manifest.toml", Path("LICENSE"))}
with zipfile.ZipFile(sys.argv[1], "w") as archive:
    for name in sorted(files):
        entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))  # the format's earliest time
        entry.external_attr = 0o644 << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        archive.writestr(entry, files[name].read_bytes())
PYTHON
sha256sum "$zip"
