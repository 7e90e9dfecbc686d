#!/usr/bin/env bash
# Checks dependencies that reach users: fixed by hash, under a licence that is compatible with mien's, and named where
# the licence requires that. Also checks that the repository contains no keys or passwords.
# usage: scripts/check/supply_chain.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build

python3 - <<'PYTHON'
import json, re, subprocess, sys
from pathlib import Path

wrong = []
PERMISSIVE = {"MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "ISC", "0BSD", "Unlicense", "CC0-1.0"}
FOR_TESTS = PERMISSIVE | {"MPL-2.0"}  # for packages that are not distributed

# npm: package-lock.json has the hash and licence of every package. Tools of the checks are not distributed.
TOOLS = FOR_TESTS | {"BlueOak-1.0.0", "CC-BY-3.0", "CC BY-SA 4.0", "Python-2.0", "WTFPL", "(MIT OR CC0-1.0)", "CC-BY-4.0"}
UNDECLARED = {"node_modules/format": "MIT"}  # its package.json has the older field "licenses"
for folder, for_development in (("apps/web", FOR_TESTS), ("apps/web/tests/bundlers", TOOLS), ("scripts/check/npm", TOOLS)):
    lock, listed = f"{folder}/package-lock.json", json.loads(Path(folder, "package.json").read_text())
    for name, package in json.loads(Path(lock).read_text())["packages"].items():
        if name and "integrity" not in package:
            wrong.append(f"{lock}: {name}: no hash")
        licence = package.get("license", UNDECLARED.get(name))
        if name and licence not in (for_development if package.get("dev") else PERMISSIVE):
            wrong.append(f"{lock}: {name}: licence {licence}")
    for package, version in {**listed.get("dependencies", {}), **listed.get("devDependencies", {})}.items():
        if not re.fullmatch(r"\d+(\.\d+)+(-[\w.]+)?", version):
            wrong.append(f"{folder}/package.json: {package}: version range (got {version}, expected one version)")
# Rust: only mien's own packages.
others = set(re.findall(r'^name = "(.*)"', Path("bindings/rust/Cargo.lock").read_text(), re.M)) - {"mien", "mien-sys"}
wrong += [f"bindings/rust/Cargo.lock: {name}: third-party package, whose licence is not checked" for name in sorted(others)]
# PyPI: each package has a version, and a hash if it is used to build the wheel.
for path in map(Path, subprocess.run(["git", "ls-files", "*requirements.txt"], capture_output=True, text=True, check=True).stdout.split()):
    for line in path.read_text().replace("\\\n", "").splitlines():
        if line and not line.startswith("#") and not re.match(r"[\w.-]+==[\w.]+", line):
            wrong.append(f"{path}: {line.split()[0]}: no version")
        if path.name == "wheel_requirements.txt" and not line.startswith("#") and "--hash=sha256:" not in line:
            wrong.append(f"{path}: {line.split()[0]}: no hash")
# third_party.txt names the packages that are compiled into programs: those of npm in reports, and those of Debian.
named = Path("apps/third_party.txt").read_text()
wrong += [f"apps/third_party.txt: {name}: not named" for name in json.loads(Path("apps/web/package.json").read_text())["dependencies"]
          if name.split("/")[-1] not in named]
titles = {"CLI": "CLI11", "nlohmann": "JSON for Modern C++", "stb": "stb_easy_font"}
system = {"mien", "netinet", "sanitizer", "sys"}
included = subprocess.run(["git", "grep", "-hoP", r"^#include <\K\w+(?=/)", "--", "apps/mien", "apps/conformance"],
                          capture_output=True, text=True, check=True).stdout.split()
wrong += [f"apps/third_party.txt: {folder}: not named" for folder in sorted(set(included) - system) if titles.get(folder, "-") not in named]

print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
sys.exit(bool(wrong))
PYTHON
echo "packages: fixed versions, hashes of distributed ones, permissive licences"

# Keys and passwords that detect-secrets knows; without its detectors of random text, which report every hash.
venv=build/secrets
[ -x $venv/bin/python ] || python3 -m venv $venv
if ! $venv/bin/pip install --quiet --disable-pip-version-check detect-secrets==1.5.0; then
  echo "NOT TESTED: keys and passwords: detect-secrets could not be installed from PyPI"
  exit
fi
find_secrets=("$venv/bin/detect-secrets-hook" --disable-plugin HexHighEntropyString --disable-plugin Base64HighEntropyString)

# Checks that it detects a key.
planted=$(mktemp)
trap 'rm -f "$planted"' EXIT
printf -- '-----BEGIN %s KEY-----\n' "RSA PRIVATE" >"$planted"
if "${find_secrets[@]}" "$planted" >/dev/null; then
  echo "check/supply_chain.sh: a private key is not detected" >&2
  exit 1
fi
git ls-files -z ':!fuzz/corpus' | xargs -0 "${find_secrets[@]}"
echo "keys and passwords: none"
