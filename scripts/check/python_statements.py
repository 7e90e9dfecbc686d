#!/usr/bin/env python3
"""Rejects statements that ruff has no rule for: several joined by commas, and conditional expressions.

usage: scripts/check/python_statements.py PATH...
"""
import ast
import subprocess
import sys
from pathlib import Path

REJECTED = {ast.Tuple: "statements joined by a comma", ast.IfExp: "a conditional expression as a statement"}


def findings(name):
    for node in ast.walk(ast.parse(Path(name).read_text())):
        if isinstance(node, ast.Expr) and type(node.value) in REJECTED:
            yield f"{name}:{node.lineno}: {REJECTED[type(node.value)]}"


def main():
    listed = subprocess.run(["git", "ls-files", *sys.argv[1:]], check=True, capture_output=True, text=True).stdout
    names = [name for name in listed.split() if name.endswith(".py") and Path(name).exists()]
    found = [line for name in names for line in findings(name)]
    print("\n".join(found), end="\n" if found else "")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
