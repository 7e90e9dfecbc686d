#!/usr/bin/env python3
"""Measures stripped programs for every target and option of the library, and writes the table of docs/packages.md.

usage: scripts/package/sizes.py [--check] [TARGET...]
  --check   changes nothing, and fails if a size differs from the table by more than 1 %
  TARGET    gcc (this machine), or a target of scripts/cross/zig.sh; default: all, and with --check those of the table.
            Columns of other targets stay as they are
"""
import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/packages.md"
BEGIN, END = "<!-- sizes.py: begin -->\n", "<!-- sizes.py: end -->\n"
TARGETS = ["gcc", "linux-x64", "linux-arm64", "linux-armv7", "macos-x64", "macos-arm64", "windows-x64", "windows-arm64"]
TOLERANCE = 0.01
NONE = "-"

X86, ARM64 = ("gcc", "linux-x64", "macos-x64", "windows-x64"), ("linux-arm64", "macos-arm64", "windows-arm64")
HALF = ["MIEN_WITH_AVX512", "MIEN_WITH_HALF_PRECISION"]  # on x86-64, half precision is a part of AVX-512
ALL = ["MIEN_WITH_AUDIO", "MIEN_WITH_HIFINET", "MIEN_WITH_FILES", *HALF]
# Rows: title, options that are on, targets that have them.
ROWS = [
    ("level 1", [], TARGETS),
    ("level 1, `MIEN_TRIM_REF`", ["MIEN_TRIM_REF"], TARGETS),
    ("level 1, `MIEN_WITH_FILES`", ["MIEN_WITH_FILES"], TARGETS),
    ("level 1, `MIEN_WITH_AVX512`", ["MIEN_WITH_AVX512"], X86),
    ("level 1, `MIEN_WITH_HALF_PRECISION`", HALF, X86 + ARM64),
    ("level 1, `MIEN_WITH_AUDIO`", ["MIEN_WITH_AUDIO"], TARGETS),
    ("levels 1 to 4, `MIEN_WITH_HIFINET`", ["MIEN_WITH_HIFINET"], TARGETS),
    ("everything", ALL, TARGETS),
]
AMALGAMATION = "amalgamation, weights in files"


def run(*command):
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}\nsizes.py: {command[0]} failed ({done.returncode})")
    return done.stdout


def zig():
    """Zig's environment and triples, from scripts/cross/zig_targets.sh."""
    printed = run("bash", "-c", '. scripts/cross/zig_targets.sh; install_zig >&2; echo "MIEN_ZIG=$MIEN_ZIG"; echo "CACHE=$ZIG_LOCAL_CACHE_DIR"; '
               'for target in "${!ZIG_TARGETS[@]}"; do echo "$target=${ZIG_TARGETS[$target]}"; done')
    values = dict(line.split("=", 1) for line in printed.splitlines() if "=" in line)
    os.environ.update(MIEN_ZIG=values["MIEN_ZIG"], ZIG_LOCAL_CACHE_DIR=values["CACHE"], ZIG_GLOBAL_CACHE_DIR=values["CACHE"])
    return values


def program_bytes(path):
    found = next(candidate for candidate in (path, path.with_suffix(".exe")) if candidate.is_file())
    return found.stat().st_size


def embedded_bytes(target, triple, options):
    build = ROOT / "build/sizes" / target / "embedded"  # one for all rows, because options change few objects
    by_zig = ["--toolchain", str(ROOT / "scripts/cross/zig.cmake"), f"-DMIEN_ZIG_TARGET={triple}",
              "-DCMAKE_C_STANDARD_LIBRARIES=-lc++"]  # the C++ library, which CMake finds for Linux only
    toolchain = ["-DCMAKE_EXE_LINKER_FLAGS=-s"] if target == "gcc" else by_zig
    switches = {option: option in options for option in (*ALL, "MIEN_TRIM_REF")} | {"MIEN_TRIM_LAYERS": options != ALL}
    run("cmake", "-S", "tests/package/embedded", "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-DMIEN_SOURCE={ROOT}",
        *toolchain, *(f"-D{option}={'ON' if on else 'OFF'}" for option, on in switches.items()))
    run("cmake", "--build", str(build), "--target", "embedded")
    return program_bytes(build / "embedded")


def amalgamation_bytes(target):
    folder = ROOT / "build/sizes" / target
    folder.mkdir(parents=True, exist_ok=True)
    run("scripts/package/amalgamate.py", "-o", str(folder / "amalgamation"))
    sources, program = folder / "amalgamation", folder / "amalgamated.exe"
    if target == "gcc":
        run("g++", "-std=c++20", "-O2", "-s", f"-I{sources}", "tests/package/amalgamated/main.cpp", *map(str, sorted(sources.glob("mien*.cpp"))),
            "-o", str(program))
    else:
        run("bash", "-c", f". scripts/cross/zig_targets.sh; build_amalgamated {target} '{sources}' '{program}'")
    return program_bytes(program)


def measured(target, triple):
    column = {title: embedded_bytes(target, triple, options) for title, options, targets in ROWS if target in targets}
    return column | {AMALGAMATION: amalgamation_bytes(target)}


def read_table(text):
    """Maps each target to its column: {title: bytes}."""
    rows = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in text.splitlines() if line.startswith("|")]
    columns = {target: {} for target in TARGETS}
    for row in rows[2:]:
        for target, cell in zip(rows[0][1:], row[1:]):
            if cell != NONE:
                columns[target][row[0]] = int(cell.replace(",", ""))
    return columns


def written_table(columns):
    known = [target for target in TARGETS if columns[target]]
    lines = [f"|program|{'|'.join(known)}|", "|---" * (len(known) + 1) + "|"]
    for title, *_ in [*ROWS, (AMALGAMATION,)]:
        cells = (f"{columns[target][title]:,}" if title in columns[target] else NONE for target in known)
        lines.append(f"|{title}|{'|'.join(cells)}|")
    return "\n".join(lines) + "\n"


def chosen(targets, columns, check):
    """The targets to measure; a check leaves out those that the table does not list."""
    return targets or [target for target in TARGETS if columns[target] or not check]


def differences(target, listed, now):
    for title, size in now.items():
        expected = listed.get(title)
        if expected is None or abs(size - expected) > TOLERANCE * expected:
            yield f"{PAGE.name}: {target}: {title}: wrong size (got {expected}, expected {size})"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("targets", nargs="*", choices=[*TARGETS, []], metavar="TARGET")
    options = parser.parse_args()
    triples = zig()
    page = PAGE.read_text()
    match = re.search(f"{BEGIN}(.*?){END}", page, re.S)
    columns, wrong = read_table(match[1]), []
    for target in chosen(options.targets, columns, options.check):
        now = measured(target, triples.get(target))
        wrong += differences(target, columns[target], now)
        columns[target] = now
        print(f"{target}: {now}")
    if options.check:
        print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
        sys.exit(bool(wrong))
    PAGE.write_text(page[:match.start(1)] + written_table(columns) + page[match.end(1):])


if __name__ == "__main__":
    main()
