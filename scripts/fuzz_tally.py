#!/usr/bin/python3
"""Adds a run of a fuzz target to a tally, and writes the total into a page.

usage: scripts/fuzz_tally.py TALLY.json PAGE.md
       [TARGET RUNS "USER SYSTEM"]     processor time in seconds; without: the total alone
"""
import json
import pathlib
import re
import sys


def total(tally):
    runs, seconds = (sum(done[key] for done in tally.values()) for key in ("runs", "seconds"))
    return f"{len(tally)} targets have run {runs:,} times in {seconds:,.0f} s"


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
    pathlib.Path(page).write_text(re.sub(r"\d+ targets have run [\d,]+ times in [\d,]+ s", total(tally), text, count=1))


if __name__ == "__main__":
    main()
