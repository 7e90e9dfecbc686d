#!/usr/bin/env python3
"""Runs clang-tidy (.clang-tidy) on every file that has not passed with the same content, includes and options.

usage: scripts/check/tidy.py BUILD_DIR [FOLDER|PATTERN.cpp...]      BUILD_DIR has compile_commands.json
Default: the library and the programs. The tests include GoogleTest, which takes ten seconds per file, so name them to
check them: scripts/check/tidy.py build/tidy tests fuzz. $XDG_CACHE_HOME/mien/tidy records the files that have passed.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PEOPLE_RUN = ["kernels", "formats", "engine", "audio", "tracker", "apps"]
REMEMBERED = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "mien/tidy"


def output_of(*command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, **options).stdout


def tracked(patterns):
    """Source files of the repository in folders, or that match patterns."""
    wanted = [pattern if pattern.endswith(".cpp") else pattern + "/*.cpp" for pattern in patterns]
    return output_of("git", "ls-files", "-z", "--", *wanted, cwd=ROOT, text=True).split("\0")[:-1]


def preprocessed(entry):
    """The preprocessed file with its comments, which may suppress checks of clang-tidy."""
    words = shlex.split(entry["command"])
    at = words.index("-o")
    options = [word for word in words[:at] + words[at + 2:] if word != "-c"]
    return output_of(*options, "-E", "-C", "-P", "-w", cwd=entry["directory"])


class Tidy:
    def __init__(self, build):
        self.build = build
        entries = json.loads((build / "compile_commands.json").read_text())
        self.entries = {os.path.relpath(entry["file"], ROOT): entry for entry in entries}
        self.rules = (ROOT / ".clang-tidy").read_bytes() + output_of("clang-tidy", "--version")

    def key(self, entry):
        command = entry["command"].replace(str(ROOT), "").encode()
        return hashlib.sha256(b"\0".join([self.rules, command, preprocessed(entry)])).hexdigest()

    def complaints(self, file):
        """The findings in a file; empty without any."""
        done = REMEMBERED / self.key(self.entries[file])
        if done.exists():
            return ""
        found = subprocess.run(["clang-tidy", "-p", str(self.build), "--quiet", file], cwd=ROOT, capture_output=True,
                               text=True)
        if found.returncode == 0 and not found.stdout:
            REMEMBERED.mkdir(parents=True, exist_ok=True)
            done.touch()
        return found.stdout + (found.stderr or f"{file}: {found.returncode}\n" if found.returncode else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("patterns", nargs="*", default=PEOPLE_RUN)
    args = parser.parse_args()
    tidy = Tidy(args.build.resolve())
    # Files outside the build, such as kernels for another CPU, cannot be checked.
    files = [file for file in tracked(args.patterns) if file in tidy.entries]
    if not files:
        sys.exit("check/tidy.py: none of these files is built in " + str(args.build))
    wrong = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for complaints in pool.map(tidy.complaints, files):
            wrong += bool(complaints)
            print(complaints, end="")
    print(f"clang-tidy: {len(files)} files, {wrong} of them wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
