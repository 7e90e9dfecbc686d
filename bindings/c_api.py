#!/usr/bin/env python3
"""Prints the declarations of mien.h, one fact per line. Tests of the bindings compare their own declarations with it.

usage: bindings/c_api.py [TARGET]      TARGET: platform of the struct layouts, by clang's name; default: this one. Needs clang.

  struct NAME BYTES          field STRUCT.MEMBER OFFSET      function NAME ARGUMENTS
  status NAME NUMBER         enum NAME NUMBER                constant NAME VALUE
"""

import re
import subprocess
import sys
from pathlib import Path

HEADER = Path(__file__).resolve().parents[1] / "include/mien/mien.h"


def members(body):
    for declaration in body.split(";"):
        pointer = re.search(r"\(\*(\w+)\)", declaration)
        yield from [pointer[1]] if pointer else re.findall(r"(\w+)(?:\[[^;]*\])?\s*(?:,|$)", declaration.strip())


def layouts(target, text):
    """Sizes and offsets, read from the compiler's output, so that no program runs."""
    names, lines = [], [f'#include "{HEADER}"']
    for struct, body in re.findall(r"typedef struct (\w+) \{(.*?)\n\} \1;", text, re.S):
        facts = [(f"struct {struct}", f"sizeof({struct})")]
        facts += [(f"field {struct}.{member}", f"offsetof({struct}, {member})") for member in members(body)]
        for name, value in facts:
            lines.append(f"unsigned fact{len(names)} = {value};")
            names.append(name)
    flags = ["-S", "-emit-llvm", "-ffreestanding", "-x", "c", "-", "-o", "-"] + [f"--target={name}" for name in target]
    code = subprocess.run(["clang", *flags], input="\n".join(lines), check=True, stdout=subprocess.PIPE, text=True).stdout
    values = dict(re.findall(r"^@fact(\d+) = .*global i32 (\d+)", code, re.M))
    return [f"{name} {values[str(number)]}" for number, name in enumerate(names)]


def facts(target):
    text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.S)
    yield from layouts(target, text)
    for name, arguments in re.findall(r"\b(mien_\w+)\(([^()]*)\);", text):
        yield f"function {name} {sum(argument.strip() != 'void' for argument in arguments.split(','))}"
    for name, number in re.findall(r"\b(MIEN_\w+) = (-?\d+)", text):
        kind = "status" if name == "MIEN_OK" or name.startswith("MIEN_ERROR_") else "enum"
        yield f"{kind} {name} {number}"
    for name, value in re.findall(r"^#define (MIEN_\w+) (0[xX][0-9A-Fa-f]+|\d+)u?\s*$", text, re.M):
        yield f"constant {name} {int(value, 0)}"


if __name__ == "__main__":
    print("\n".join(facts(sys.argv[1:2])))
