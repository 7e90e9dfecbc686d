#!/usr/bin/python3
"""Adds a run of a fuzz target to a tally, and makes the table of a page of all runs.

usage: scripts/fuzz_tally.py TALLY.json PAGE.md
       [TARGET RUNS "USER SYSTEM"]     processor time in seconds; without: the table alone
"""
import json
import pathlib
import re
import sys


def table(tally):
    rows = [(f"`{name}`", done["runs"], done["seconds"]) for name, done in tally.items()]
    rows.append(("all", sum(row[1] for row in rows), sum(row[2] for row in rows)))
    lines = [f"| {name} | {runs:,} | {seconds:,.0f} |" for name, runs, seconds in rows]
    return "\n".join(["| target | runs | processor time, s |", "|---|---|---|", *lines])


def main():
    path, page, *run = sys.argv[1:]
    tally = json.loads(pathlib.Path(path).read_text())
    if run:
        name, runs, used = run
        done = tally.setdefault(name, {"runs": 0, "seconds": 0})
        done["runs"] += int(runs)
        done["seconds"] = round(done["seconds"] + sum(map(float, used.split())), 1)
        pathlib.Path(path).write_text(json.dumps(tally, indent=1) + "\n")
    text = pathlib.Path(page).read_text()
    pathlib.Path(page).write_text(re.sub(r"\| target \|.*?(?=\n\n)", lambda _: table(tally), text, count=1,
                                         flags=re.DOTALL))


if __name__ == "__main__":
    main()
