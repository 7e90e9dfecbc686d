#!/usr/bin/env python3
"""Checks that project files parse, and that the commands and paths they name exist.

usage: project_files.py, in the root of the repository
"""
import json
import re
import subprocess
import sys
from pathlib import Path

import yaml

SCRIPT = re.compile(r"(?<![\w./-])(?:scripts|bindings)/[\w./-]+\.(?:sh|py)\b")
PRESET = re.compile(r"--preset[ =]([\w-]+)")


def tracked(*patterns):
    listing = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns],
                             capture_output=True, text=True, check=True)
    return sorted(Path(line) for line in listing.stdout.splitlines())


def parse_errors(paths, parse):
    for path in paths:
        try:
            parse(path.read_text())
        except ValueError as error:
            yield f"{path}: {error}"
        except yaml.YAMLError as error:
            yield f"{path}: {error}"


def missing_references(paths, presets):
    for path in paths:
        text = path.read_text()
        for script in sorted(set(SCRIPT.findall(text))):
            if not Path(script).is_file():
                yield f"{path}: {script}: no such file"
        for preset in sorted(set(PRESET.findall(text)) - presets):
            yield f"{path}: {preset}: no such preset"


def missing_directories(dependabot):
    for update in dependabot["updates"]:
        for directory in update.get("directories", [update.get("directory")]):
            if not Path(directory.lstrip("/") or ".").is_dir():
                yield f".github/dependabot.yml: {directory}: no such directory"


def invalid_owners(text):
    for number, line in enumerate(text.splitlines(), 1):
        fields = line.split("#")[0].split()
        if fields and not all(re.fullmatch(r"@[\w-]+(/[\w.-]+)?|\S+@\S+", owner) for owner in fields[1:]):
            yield f".github/CODEOWNERS:{number}: not a user, team or e-mail address"


def main():
    presets = json.loads(Path("CMakePresets.json").read_text())
    names = {preset["name"] for kind in ("configurePresets", "buildPresets", "testPresets") for preset in presets[kind]}
    workflows = tracked(".github/workflows/*.yml")
    yaml_files = tracked(".github/*.yml", "CITATION.cff", ".pre-commit-config.yaml")
    json_files = tracked("CMakePresets.json", ".devcontainer/*.json", "*package.json", ".textlintrc.json",
                         "*cspell.json")
    named = [*workflows, Path("CONTRIBUTING.md"), Path(".pre-commit-config.yaml"),
             Path(".devcontainer/devcontainer.json")]
    errors = [
        *parse_errors(yaml_files, yaml.safe_load),
        *parse_errors(json_files, json.loads),
        *missing_references(named, names),
        *missing_directories(yaml.safe_load(Path(".github/dependabot.yml").read_text())),
        *invalid_owners(Path(".github/CODEOWNERS").read_text()),
    ]
    print("\n".join(errors), file=sys.stderr, end="\n" if errors else "")
    print(f"project files: {len(yaml_files)} YAML and {len(json_files)} JSON files parsed")
    return bool(errors)


if __name__ == "__main__":
    sys.exit(main())
