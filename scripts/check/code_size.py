#!/usr/bin/env python3
"""Counts the lines of code of a folder and fails above a limit.

usage: scripts/check/code_size.py FOLDER LIMIT [--folders]

Code is every line of a text file that is not blank, not a comment and not a docstring. Data and generated files do not
count: *.json, *.npz, and the word list of the spelling check.
"""
import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NOT_CODE = (".json", ".npz", "words.txt")
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def docstrings(source):
    """Numbers of the lines of all docstrings."""
    nodes = [node.body[0] for node in ast.walk(ast.parse(source))
             if isinstance(node, DOCUMENTED) and ast.get_docstring(node)]
    return {line for node in nodes for line in range(node.lineno, node.end_lineno + 1)}


def code_lines(path):
    source = path.read_text()
    comment = "//" if path.suffix in (".c", ".cpp", ".h", ".mjs") else "#"
    skipped = docstrings(source) if path.suffix == ".py" else set()
    lines = enumerate(source.splitlines(), 1)
    return sum(1 for number, line in lines
               if line.strip() and not line.lstrip().startswith(comment) and number not in skipped)


def main():
    top, limit = sys.argv[1], int(sys.argv[2])
    listed = subprocess.run(["git", "ls-files", top], cwd=ROOT, check=True, capture_output=True,
                            text=True).stdout.split()
    files = [ROOT / name for name in listed if not name.endswith(NOT_CODE)]
    counts, total = Counter(), 0
    for path in filter(Path.exists, files):
        counts[str(path.relative_to(ROOT / top).parent)] += code_lines(path)
        total += len(path.read_text().splitlines())
    if "--folders" in sys.argv:
        for folder, count in counts.most_common():
            print(f"{count:6} {folder}")
    code = sum(counts.values())
    print(f"{top}: {code} lines of code (limit {limit}), {total} lines with comments, docstrings and blank lines")
    return code > limit


if __name__ == "__main__":
    sys.exit(main())
