#!/usr/bin/env python3
"""Writes the software bill of materials of a release, SPDX 2.3 in JSON: every file, and the third-party code in them.

usage: scripts/package/sbom.py VERSION FOLDER      (SOURCE_DATE_EPOCH: its date)
"""

import hashlib
import json
import os
import re
import subprocess
import sys
from datetime import datetime, timezone
from pathlib import Path

# Headers that are compiled into the programs, by their Debian packages; the library has nothing but the standard library.
IN_PROGRAMS = {"libcli11-dev": ("CLI11", "BSD-3-Clause"), "nlohmann-json3-dev": ("nlohmann-json", "MIT"), "libstb-dev": ("stb", "MIT OR Unlicense")}
# npm packages in the viewer of reports (apps/web/viewer.mjs).
IN_REPORTS = ("three", "@pixiv/three-vrm")
WITH_PROGRAMS = re.compile(rf"\.deb$|\.whl$|-linux-{os.uname().machine}\.tar\.gz$|-conformance-|-static\.tar\.gz$|-windows-x64\.zip$")
# Libraries that Zig links statically, with the version of its PyPI package; zlib is Debian's source.
BY_ZIG = re.compile(r"-conformance-|-static\.tar\.gz$|-windows-x64\.zip$|-(manylinux|musllinux|macosx|win)_\w+\.whl$")
IN_ZIG = {"libc++": "Apache-2.0 WITH LLVM-exception", "musl": "MIT", "mingw-w64": "ZPL-2.1"}


def debian_version(package):
    found = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], capture_output=True, text=True)
    return found.stdout if found.returncode == 0 and found.stdout else "NOASSERTION"


def zig_version():
    return re.search(r"ziglang==([0-9.]+)", (Path(__file__).parents[1] / "cross/zig_targets.sh").read_text())[1]


def package(name, version, licence, **more):
    return {"SPDXID": "SPDXRef-" + "".join(c if c.isalnum() or c in ".-" else "-" for c in name), "name": name, "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": licence, "licenseDeclared": licence,
            "copyrightText": "NOASSERTION", **more}


def relation(one, kind, other):
    return {"spdxElementId": one["SPDXID"], "relationshipType": kind, "relatedSpdxElement": other["SPDXID"]}


def document(version, folder):
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name != "SHA256SUMS" and not path.name.endswith(".spdx.json"))
    mien = package("mien", version, "Apache-2.0")
    linked = [package(name, f"of ziglang {zig_version()}", licence) for name, licence in IN_ZIG.items()]
    linked.append(package("zlib", debian_version("zlib1g"), "Zlib"))
    parts = [package(title, debian_version(name), licence) for name, (title, licence) in IN_PROGRAMS.items()]
    npm = json.loads((Path(__file__).parents[2] / "apps/web/package.json").read_text())["dependencies"]
    parts += [package(name, npm[name], "MIT") for name in IN_REPORTS]
    artifacts, relations, used = [], [], []
    for path in files:
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        artifact = package(path.name, version, "Apache-2.0", packageFileName=path.name,
                           checksums=[{"algorithm": "SHA256", "checksumValue": digest}])
        artifacts.append(artifact)
        relations.append(relation(artifact, "GENERATED_FROM", mien))
        contained = parts * bool(WITH_PROGRAMS.search(path.name)) + linked * bool(BY_ZIG.search(path.name))
        relations += [relation(artifact, "CONTAINS", part) for part in contained]
        used += [part for part in contained if part not in used]
    described = {"SPDXID": "SPDXRef-DOCUMENT"}
    digest = hashlib.sha256("".join(artifact["checksums"][0]["checksumValue"] for artifact in artifacts).encode()).hexdigest()
    created = datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"mien-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/mien-{version}-{digest}",
        "creationInfo": {"created": created, "creators": ["Tool: scripts/package/sbom.py"]},
        "packages": [mien, *artifacts, *used],
        "relationships": [relation(described, "DESCRIBES", mien), *(relation(described, "DESCRIBES", a) for a in artifacts), *relations],
    }


if __name__ == "__main__":
    release, where = sys.argv[1], Path(sys.argv[2])
    (where / f"mien-{release}.spdx.json").write_text(json.dumps(document(release, where), indent=2) + "\n")
