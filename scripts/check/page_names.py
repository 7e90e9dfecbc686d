#!/usr/bin/env python3
"""Checks that files and tests that the pages name in code font exist.

usage: page_names.py PAGE...
"""
import re
import subprocess
import sys
from pathlib import Path

FOLDERS = "apps|audio|bindings|docs|engine|formats|fuzz|include|kernels|models|scripts|tests|tracker"
PATH = re.compile(rf"(?<![\w/.<$~-])((?:{FOLDERS})/[\w./-]+)")
TEST = re.compile(r"^([A-Z]\w+)\.([A-Z]\w*|\*)(?:\.\.\.|\*)?$")
PLACEHOLDER = re.compile(r"[A-Z]{4,}|/dist$")  # NAME, FAMILY; folders that a build creates


def lines_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


class Tree:
    def __init__(self):
        self.files = lines_of("git", "ls-files")
        self.folders = {"/".join(f.split("/")[:i]) for f in self.files for i in range(1, f.count("/") + 1)}
        tests = lines_of("git", "grep", "-hoE", r"(TEST|TEST_F|TEST_P|TYPED_TEST)\(\w+, *\w+", "--", "*.cpp")
        self.tests = {".".join(re.findall(r"\w+", line)[1:]) for line in tests}
        classes = lines_of("git", "grep", "-hoE", r"class \w+\(unittest", "--", "*.py")
        self.suites = {test.split(".")[0] for test in self.tests} | {line.split()[1].split("(")[0] for line in classes}

    def has_path(self, path):
        return path in self.folders or any(f == path or f.startswith((path + ".", path + "_")) for f in self.files)

    def has_test(self, suite, name):
        return name == "*" and suite in self.suites or any(t.startswith(f"{suite}.{name}") for t in self.tests)


def unknown(tree, page):
    """(line number, name) of each name that does not exist."""
    for number, line in enumerate(Path(page).read_text().splitlines(), 1):
        for code in re.findall(r"`([^`]+)`", line):
            for path in PATH.findall(code):
                path = path.rstrip("/.")
                if not PLACEHOLDER.search(path) and not tree.has_path(path):
                    yield number, path
            test = TEST.match(code)
            if test and page.startswith("docs/") and not tree.has_test(*test.groups()):
                yield number, code


def main(pages):
    tree = Tree()
    missing = [f"{page}:{number}: {name}: no such file or test" for page in pages
               for number, name in unknown(tree, page)]
    print("\n".join(missing), end="\n" if missing else "", file=sys.stderr)
    return bool(missing)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
