#!/usr/bin/env python3
"""Follows a README as a newcomer would, from its text alone, in a copy of the repository, and expects the controls of a face.

usage: paths_test.py NAME...      NAME: one of PATHS below

Saves the page's program under its file name there, and runs the page's commands, which may be at most two. A pipeline counts as one
command; saving a program does not count. Then runs the commands once more: with everything compiled they must take less than
60 s. Exits with 77 and says so where a tool is missing.
"""
import csv
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass

from code_blocks import ROOT, blocks, commands

MOST_COMMANDS, MOST_SECONDS, SKIPPED = 2, 60, 77


@dataclass(frozen=True)
class Way:
    page: str
    tools: str
    files: dict  # from names of files to (language, number) of the page's blocks
    commands: int = 1  # number of the block in `sh`
    only: str = "."  # commands of the block that belong to this path
    value: str = r"jawOpen ([\d.]+)"  # jawOpen in the output
    curves: str = ""  # the CSV that the commands write instead
    rows: int = 200  # at least
    environment: bool = False  # creates a virtual environment of Python first


FIRST_COLUMN = r"^([01][.,]\d\d) "
README = "README.md"
PATHS = {
    "program": Way(README, "cmake", {}, 1, only="demo|mien track", curves="curves.csv"),
    "python": Way(README, "python3", {"app.py": ("python", 1)}, 2, value=r"^[\d.]+ ([\d.]+) ", environment=True),
    "cpp": Way(README, "cmake", {"app.cpp": ("cpp", 1)}, 3),
    "javascript": Way(README, "emcc node npm", {"app/app.mjs": ("js", 1)}, 4, rows=1),
    "csharp": Way("bindings/csharp/README.md", "mcs mono", {"Example.cs": ("csharp", 1)}, value=FIRST_COLUMN),
    "java": Way("bindings/android/README.md", "javac", {"Example.java": ("java", 1)}, value=FIRST_COLUMN),
    "rust": Way(
        "bindings/rust/README.md",
        "cargo",
        {"example/Cargo.toml": ("toml", 1), "example/src/main.rs": ("rust", 1)},
        value=FIRST_COLUMN,
    ),
    "swift": Way("bindings/swift/README.md", "swift", {"example/Package.swift": ("swift", 1), "example/Sources/example/main.swift": ("swift", 2)}),
}


def fail(message):
    raise SystemExit(f"paths_test.py: {message}")


def block(page, language, number):
    found = [code for name, code in blocks((ROOT / page).read_text()) if name == language]
    if len(found) < number:
        fail(f"{page}: no such block (got {language} {number}, expected 1 to {len(found)})")
    return found[number - 1]


def commands_of(path):
    return [command for command in commands(block(path.page, "sh", path.commands)) if re.search(path.only, command)]


def prepare(path):
    """A folder with the repository's files, without what earlier runs left except for what they compiled."""
    work = ROOT / "build/readme"
    (work / "build").mkdir(parents=True, exist_ok=True)
    for old in work.iterdir():
        if old.name != "build":
            shutil.rmtree(old) if old.is_dir() and not old.is_symlink() else old.unlink()
    copy = f"git ls-files -z --cached --others --exclude-standard | xargs -0 cp -p --parents -t '{work}'"
    subprocess.run(copy, shell=True, cwd=ROOT, check=True)
    (work / "face.mp4").symlink_to(ROOT / "tests/data/demo.mp4")
    subprocess.run(["ffmpeg", "-v", "error", "-ss", "4", "-i", "face.mp4", "-frames:v", "1", "face.jpg"], cwd=work, check=True)
    text = (ROOT / path.page).read_text()
    for name, (language, number) in path.files.items():
        if f"`{name}`" not in text:
            fail(f"{path.page}: does not name the file {name}")
        (work / name).parent.mkdir(parents=True, exist_ok=True)
        (work / name).write_text(block(path.page, language, number))
    return work


def run(name, path, work, environment):
    began = time.monotonic()
    script = "set -euo pipefail\n" + "\n".join(commands_of(path))
    result = subprocess.run(
        ["bash", "-c", script], cwd=work, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    seconds = time.monotonic() - began
    values = [float(value.replace(",", ".")) for value in re.findall(path.value, result.stdout, re.MULTILINE)]
    if path.curves and not result.returncode:
        values = [float(row["jawOpen"]) for row in csv.DictReader((work / path.curves).open())]
    if result.returncode or len(values) < path.rows or min(values) < 0 or not 0.3 < max(values) <= 1:
        print(result.stdout, file=sys.stderr)
        fail(f"{name}: wrong output (got status {result.returncode} and {len(values)} values of jawOpen up to {max(values, default=0)})")
    return seconds


def follow(name):
    path = PATHS[name]
    count = len(commands_of(path))
    if count > MOST_COMMANDS:
        fail(f"{path.page}: too many commands (got {count}, expected at most {MOST_COMMANDS})")
    missing = [tool for tool in ["ffmpeg", *path.tools.split()] if shutil.which(tool) is None]
    if missing:
        print(f"NOT TESTED: {path.page}, for which there is no {missing[0]}")
        return SKIPPED
    work = prepare(path)
    environment = {**os.environ, "CCACHE_BASEDIR": str(work)}
    if path.environment:
        subprocess.run([sys.executable, "-m", "venv", work / "environment"], check=True)
        environment["PATH"] = f"{work}/environment/bin:{environment['PATH']}"
    first = run(name, path, work, environment)
    again = run(name, path, work, environment)
    print(f"{name}: {count} commands of {path.page}: {first:.1f} s with compilation, {again:.1f} s without")
    if again >= MOST_SECONDS:
        fail(f"{name}: too slow (got {again:.1f} s without compilation, expected less than {MOST_SECONDS})")
    return 0


def main(names):
    if not names or set(names) - set(PATHS):
        raise SystemExit(__doc__ + "\nnames: " + " ".join(PATHS))
    return max(follow(name) for name in names)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
