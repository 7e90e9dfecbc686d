#!/usr/bin/env python3
"""Prints code blocks of a Markdown page as readers see them, for tests that run them.

usage: code_blocks.py PAGE.md LANGUAGE [NUMBER]      all blocks in the language, or one of them, from 1
       code_blocks.py --check                        fails for each page and language whose code no test runs
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^ {0,3}(`{3,}|~{3,})\s*([\w+-]*)")
NOT_RUN = {"text": "no code", "swift": "no compiler is available"}


def blocks(text):
    """(language, code) of each fenced block; an unlabelled block has the language ''."""
    fence, language, lines = "", "", []
    for line in text.splitlines(keepends=True):
        found = FENCE.match(line)
        if not fence and found:
            fence, language, lines = found[1], found[2], []
        elif fence and line.strip().startswith(fence) and not line.strip().strip(fence[0]):
            yield language, "".join(lines)
            fence = ""
        elif fence:
            lines.append(line)


def tracked(*patterns):
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [name for name in listed.splitlines() if (ROOT / name).exists()]


def check():
    from paths_test import PATHS

    tests = "\n".join((ROOT / name).read_text() for name in tracked("tests/*.sh", "bindings/*.sh", "*.test.mjs"))
    for path in PATHS.values():
        tests += "".join(f"\n{path.page} {language}" for language, _ in [*path.files.values(), ("sh", 1)])
    missing = 0
    for page in tracked("*.md"):
        for language in sorted({language for language, _ in blocks((ROOT / page).read_text())} - {""} - NOT_RUN.keys()):
            if not re.search(rf"{re.escape(page)}\W+{re.escape(language)}\b", tests):
                print(f"{page}: {language}: no test runs these code blocks", file=sys.stderr)
                missing = 1
    return missing


def main(arguments):
    if arguments == ["--check"]:
        return check()
    if len(arguments) not in (2, 3):
        raise SystemExit(__doc__)
    page, language, *number = arguments
    found = [code for name, code in blocks((ROOT / page).read_text()) if name == language]
    first, last = (int(number[0]) - 1, int(number[0])) if number else (0, len(found))
    if not found[first:last]:
        raise SystemExit(f"code_blocks.py: {page}: no such block (got {language} {' '.join(number)}, expected 1 of {len(found)})")
    print("\n".join(found[first:last]), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
