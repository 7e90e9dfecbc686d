"""The page of results."""
import collections
import json

from .worker import KILLED, SURVIVED, WAITING

MIN_KILLED = 0.95
ALIVE = (SURVIVED, WAITING)


def folder_of(file):
    parts = file.split("/")
    return "/".join(parts[:2]) if parts[1] in ("animation", "protocols") else parts[0]


class Argued:
    """Survivors that change nothing anybody could notice, each with the reason (equivalent_mutants.json)."""

    def __init__(self, path):
        entries = json.loads(path.read_text()) if path.is_file() else []
        self._reasons = {(entry["file"], entry["before"], entry["after"]): entry["reason"] for entry in entries}

    def reason(self, result):
        return self._reasons.get((result["file"], result["before"].strip(), result["after"].strip()))


def share(killed, missed):
    return f"{100 * killed / (killed + missed):.1f} %" if killed + missed else "none"


def table(results, argued):
    counts = collections.defaultdict(collections.Counter)
    for result in results:
        outcome = result["outcome"]
        if outcome in ALIVE and argued.reason(result):
            outcome = "equivalent"
        elif outcome in ALIVE:
            outcome = SURVIVED
        for name in (folder_of(result["file"]), "all"):
            counts[name][outcome] += 1
    rows = ["| folder | killed | survived | share | argued equivalent |", "|---|---|---|---|---|"]
    for name in sorted(counts, key=lambda name: (name == "all", name)):
        count = counts[name]
        rows.append(
            f"| {name} | {count[KILLED]} | {count[SURVIVED]} | {share(count[KILLED], count[SURVIVED])} | "
            f"{count['equivalent']} |")
    return rows


def listed(results):
    places = ", ".join(f"`{result['file']}` {result['line']}" for result in results)
    return ["", f"Lines of survivors: {places}."] if results else []


def page(results, argued, opening):
    results = sorted(results, key=lambda result: (result["file"], result["line"], result["after"]))
    survived = [result for result in results if result["outcome"] in ALIVE and not argued.reason(result)]
    killed = share(sum(result["outcome"] == KILLED for result in results), len(survived))
    return "\n".join([opening, f"Tests kill {killed} of the mutants that count.", "", *table(results, argued),
                      *listed(survived), ""])


def enough_killed(results, argued):
    killed = sum(result["outcome"] == KILLED for result in results)
    missed = sum(result["outcome"] in ALIVE and not argued.reason(result) for result in results)
    return killed >= MIN_KILLED * (killed + missed)
