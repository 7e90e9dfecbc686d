#!/usr/bin/env python3
"""Sums up coverage by folder and compares it with the goals.

usage: coverage_report.py EXPORT.json UNCOVERED.txt REPORT.md      (see coverage.sh)
EXPORT.json is llvm-cov's. UNCOVERED.txt gets one line per uncovered range of lines and side of a branch; REPORT.md gets
the new table. Exit status 0 only if the goals are met.
"""
import json
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = ("audio", "engine", "formats", "kernels", "tracker")
LINES_OF_LIBRARY, BRANCHES_OF_PARSERS = 90.0, 95.0
# CPU features that the tests of a tier need.
TIERS = {"avx2": "avx2", "avx512": "avx512f", "avx512fp16": "avx512_fp16", "avx512vnni": "avx512_vnni",
         "avx2int16": "avx2", "avxvnni": "avx_vnni"}
BEGIN, END = "<!-- made by scripts/coverage.sh -->", "<!-- to here -->"


def missing_tiers():
    flags = set(Path("/proc/cpuinfo").read_text().split())
    return [tier for tier, flag in TIERS.items() if flag not in flags]


def tier_of(path):
    """The tier of a file that is compiled for it alone, such as avx512fp16_product.cpp; otherwise None."""
    name = path.stem.split("_")[0]
    return name if path.parts[0] == "kernels" and name in TIERS else None


def is_writer(path):
    return path.name in ("mien_writer.cpp", "weight_packing.cpp", "fp16.cpp") or "writer" in path.stem


def rooms_of(path):
    """The rows of the table that a file counts for."""
    folder = "/".join(path.parts[:2]) if path.parts[0] == "apps" else path.parts[0]
    yield folder
    if path.parts[0] in LIBRARY and folder in LIBRARY and not is_writer(path):
        yield "the library"
    if folder in ("formats", "apps/animation") and not is_writer(path):
        yield "parsers"


def uncovered_lines(segments):
    """Ranges of lines of uncovered regions. A segment is [line, column, count, has a count, begins a region, is a
    gap]."""
    for here, following in zip(segments, segments[1:]):
        if here[3] and not here[2] and here[4] and not here[5]:
            yield here[0], following[0]


def uncovered_sides(branches):
    """A template's branch stands there once for each of its instances."""
    counts = {}
    for line, column, _, _, taken, not_taken, *_ in branches:
        before = counts.get((line, column), (0, 0))
        counts[line, column] = before[0] + taken, before[1] + not_taken
    for (line, column), (taken, not_taken) in sorted(counts.items()):
        if not taken or not not_taken:
            yield line, column, "never" if not taken and not not_taken else "never true" if not taken else "always true"


def percent(part):
    covered, count = part
    return 100.0 * covered / count if count else 100.0


def main(export, uncovered, report):
    rooms, left_out, remarks = {}, missing_tiers(), []
    for file in json.loads(Path(export).read_text())["data"][0]["files"]:
        path = Path(os.path.relpath(file["filename"], ROOT))
        if path.parts[0] not in LIBRARY or tier_of(path) in left_out:
            continue
        sides = list(uncovered_sides(file["branches"]))
        remarks += [f"{path}:{a}: not run{f' (to {b})' if b != a else ''}"
                    for a, b in uncovered_lines(file["segments"])]
        remarks += [f"{path}:{line}:{column}: {what}" for line, column, what in sides]
        for room in rooms_of(path):
            sums = rooms.setdefault(room, {"lines": [0, 0], "branches": [0, 0]})
            for kind in sums:
                sums[kind][0] += file["summary"][kind]["covered"]
                sums[kind][1] += file["summary"][kind]["count"]
    Path(uncovered).write_text("".join(f"{remark}\n" for remark in remarks))

    met = (percent(rooms["the library"]["lines"]) >= LINES_OF_LIBRARY
           and percent(rooms["parsers"]["branches"]) >= BRANCHES_OF_PARSERS)
    rows = [f"Goals: lines of the library {LINES_OF_LIBRARY:.0f} %, branches of parsers {BRANCHES_OF_PARSERS:.0f} %: "
            f"{'met' if met else 'missed'}.", "", "| | lines, % | branches, % |", "|---|---|---|"]
    for room in ("the library", "parsers"):
        parts = rooms[room]["lines"], rooms[room]["branches"]
        rows.append(f"| {room} | " + " | ".join(f"{percent(p):.1f}" for p in parts) + " |")
    rows += ["",
             f"Excluded tiers, which this CPU lacks: {', '.join(left_out) or 'none'}; tiers of other machines are not "
             "compiled."]
    text = Path(report).read_text()
    before, rest = text.split(BEGIN)
    Path(report).write_text("\n".join([before + BEGIN, *rows, END + rest.split(END)[1]]))
    print("\n".join(rows))
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
