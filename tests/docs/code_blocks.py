#!/usr/bin/env python3
"""Prints code blocks of a Markdown page as readers see them, for tests that run them.

usage: code_blocks.py PAGE.md LANGUAGE [NUMBER]      all blocks in the language, or one of them, from 1
       code_blocks.py --check                        fails for each block without a language or whose code no test runs
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^ {0,3}(`{3,}|~{3,})\s*([\w+-]*)")
NOT_RUN = {"text": "no code"}
COMMANDS_NOT_RUN = {  # by their beginning
    "scripts/test.sh": "CI and nightly tests call it",
    "build/release/apps/mien/mien live": "needs a camera; the tests of apps/mien replace it",
}
SHELL_NOT_RUN = {
    "CONTRIBUTING.md": "scripts/test.sh uses the same presets; debuggers wait for a person, and releases need a key",
    "apps/blender/README.md": "tests/blender tests the add-on with such packets and curves",
    "docs/conformance.md": "tests of the program use the options; a telephone is absent",
    "docs/convert.md": "tests/apps/convert_test.py converts networks; `model.onnx` is yours",
    "docs/cross.md": "scripts/cross/all.sh builds for these targets; the NDK is absent",
    "docs/live.md": "needs a camera and receivers; tests/apps/live_*.py replace them",
    "docs/packages.md": "scripts/package and tests/package build these packages; verification needs a release",
    "docs/results/int8.md": "needs a network in training",
    "docs/results/live.md": "is a measurement",
    "docs/training.md": "takes days",
    "docs/web.md": "scripts/test_rest.sh calls it; a server runs until it is interrupted",
    "fuzz/README.md": "scripts/test_rest.sh fuzzes",
}


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


def commands(code):
    """The commands in a block of shell code, without comments; a pipeline is one command."""
    lines = re.sub(r"\s+#.*|\\\n", "", code).splitlines()
    return [part.strip() for line in lines for part in re.split(r";|&&", line) if part.strip()]


def check():
    """The number of mistakes: blocks without a language, and code that no test runs."""
    from paths_test import PATHS, commands_of

    tests = "\n".join((ROOT / name).read_text() for name in tracked("tests/*.sh", "bindings/*.sh", "*.test.mjs"))
    programs = {(path.page, language) for path in PATHS.values() for language, _ in path.files.values()}
    followed = {command for path in PATHS.values() for command in commands_of(path)}

    def runs(page, language, code):
        if language in NOT_RUN or (page, language) in programs or re.search(rf"{re.escape(page)}\W+{re.escape(language)}\b", tests):
            return True
        if language != "sh":
            return False
        return page in SHELL_NOT_RUN or all(one in followed or one.startswith(tuple(COMMANDS_NOT_RUN)) for one in commands(code))

    mistakes = 0
    for page in tracked("*.md"):
        for language, code in blocks((ROOT / page).read_text()):
            if not language or not runs(page, language, code):
                problem = "no test runs this code block" if language else "a code block has no language (sh for commands, text for output)"
                print(f"{page}: {language}: {problem}:\n{code}", file=sys.stderr)
                mistakes += 1
    return mistakes


def main(arguments):
    if arguments == ["--check"]:
        return min(check(), 1)
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
