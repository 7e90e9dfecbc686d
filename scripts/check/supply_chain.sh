#!/usr/bin/env bash
# What others have made and that reaches users comes as it was chosen: by its hash, under a licence that mien's users can live with, and
# named where the licence asks for that. And no key or password is in the tree.
# usage: scripts/check/supply_chain.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build

python3 - <<'PYTHON'
import json, re, subprocess, sys
from pathlib import Path

wrong = []
PERMISSIVE = {"MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "ISC", "0BSD", "Unlicense", "CC0-1.0"}
FOR_TESTS = PERMISSIVE | {"MPL-2.0"}  # of what never leaves this machine

# npm: package-lock.json has every package's hash and licence. Tools of the checks reach no user.
TOOLS = FOR_TESTS | {"BlueOak-1.0.0", "CC-BY-3.0", "CC BY-SA 4.0", "Python-2.0", "WTFPL", "(MIT OR CC0-1.0)"}
UNDECLARED = {"node_modules/format": "MIT"}  # its package.json has the older field "licenses"
for folder, for_development in (("apps/web", FOR_TESTS), ("scripts/check/npm", TOOLS)):
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
# Rust: mien's own packages alone.
others = set(re.findall(r'^name = "(.*)"', Path("bindings/rust/Cargo.lock").read_text(), re.M)) - {"mien", "mien-sys"}
wrong += [f"bindings/rust/Cargo.lock: {name}: others' packages need a look at their licences" for name in sorted(others)]
# PyPI: each package a version, and what makes the wheel its hash as well.
for path in map(Path, subprocess.run(["git", "ls-files", "*requirements.txt"], capture_output=True, text=True, check=True).stdout.split()):
    for line in path.read_text().replace("\\\n", "").splitlines():
        if line and not line.startswith("#") and not re.match(r"[\w.-]+==[\w.]+", line):
            wrong.append(f"{path}: {line.split()[0]}: no version")
        if path.name == "wheel_requirements.txt" and not line.startswith("#") and "--hash=sha256:" not in line:
            wrong.append(f"{path}: {line.split()[0]}: no hash")
# Debian: what is compiled into the programs is named to their users.
named = Path("apps/third_party.txt").read_text()
titles = {"CLI": "CLI11", "nlohmann": "JSON for Modern C++", "stb": "stb_easy_font"}
system = {"mien", "netinet", "sanitizer", "sys"}
included = subprocess.run(["git", "grep", "-hoP", r"^#include <\K\w+(?=/)", "--", "apps/mien", "apps/conformance"],
                          capture_output=True, text=True, check=True).stdout.split()
wrong += [f"apps/third_party.txt: {folder}: not named" for folder in sorted(set(included) - system) if titles.get(folder, "-") not in named]

print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
sys.exit(bool(wrong))
PYTHON
echo "packages: each by its version, what reaches users by its hash, all licences permissive and named"

# Keys and passwords, as detect-secrets knows them; without the detectors of random text, to which every hash is one.
venv=build/secrets
[ -x $venv/bin/python ] || python3 -m venv $venv
if ! $venv/bin/pip install --quiet --disable-pip-version-check detect-secrets==1.5.0; then
  echo "NOT TESTED: keys and passwords, since detect-secrets could not be had from PyPI"
  exit
fi
find_secrets=("$venv/bin/detect-secrets-hook" --disable-plugin HexHighEntropyString --disable-plugin Base64HighEntropyString)

# It has to notice, before its silence counts.
planted=$(mktemp)
trap 'rm -f "$planted"' EXIT
printf -- '-----BEGIN %s KEY-----\n' "RSA PRIVATE" >"$planted"
if "${find_secrets[@]}" "$planted" >/dev/null; then
  echo "check/supply_chain.sh: a private key is not noticed" >&2
  exit 1
fi
git ls-files -z ':!fuzz/corpus' | xargs -0 "${find_secrets[@]}"
echo "keys and passwords: none in the tree"
