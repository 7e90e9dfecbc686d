"""Mutation testing: changes of single lines of the library, which tests should detect.

usage: scripts/mutate.sh [options]      scripts/mutate.sh --help
"""
import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading

from . import checks, mutants, report
from .base import Base
from .worker import KILLED, SURVIVED, WAITING, BrokenTests, Times, Worker

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build/mutate"
PAGE = ROOT / "docs/results/mutations.md"
ARGUED = ROOT / "tests/mutation/equivalent_mutants.json"
GOAL = 300  # mutants that compile and change the machine code


def options():
    parser = argparse.ArgumentParser(prog="scripts/mutate.sh", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=GOAL,
                        help=f"mutants that compile and change the machine code (default {GOAL})")
    parser.add_argument("--seed", type=int, default=1, help="of the sample (default 1)")
    parser.add_argument("--workers", type=int, default=1, help="mutants at a time (default 1)")
    parser.add_argument("--results", type=pathlib.Path, default=WORK / "results.jsonl",
                        help="results so far: a run continues where the last one ended (default "
                             "build/mutate/results.jsonl)")
    parser.add_argument("--again", action="store_true",
                        help="try mutants again that survived, since there are more tests now")
    parser.add_argument("--only", nargs="+", metavar="FILE", help="mutants of these files alone")
    parser.add_argument("--report", action="store_true",
                        help="run nothing; write docs/results/mutations.md from the results")
    return parser.parse_args()


class Results:
    """Outcomes by the key of their mutant; the last one of a key counts."""

    def __init__(self, path):
        self._path, self._lock = path, threading.Lock()
        lines = path.read_text().splitlines() if path.is_file() else []
        self.by_key = {result["key"]: result for result in map(json.loads, lines)}

    def add(self, mutant, outcome):
        result = {"key": mutant.key, "file": mutant.file, "line": mutant.line, "before": mutant.before.strip(),
                  "after": mutant.after.strip(), **outcome}
        with self._lock:
            self.by_key[mutant.key] = result
            with self._path.open("a") as file:
                file.write(json.dumps(result) + "\n")
        return result


class Sample:
    """The first valid mutants of an order, one by one: all of them for the quick tests, then the survivors for the
    slow ones."""

    def __init__(self, order, results, count, again):
        self._order, self._results, self._count = order, results, count
        self._again = {key for key, result in results.by_key.items()
                       if again and result["outcome"] in (SURVIVED, WAITING)}
        self._next, self._lock, self._running, self._handed = 0, threading.Lock(), 0, set()

    def take(self):
        """(the next mutant to try, whether it is the slow tests' turn); None when there are enough."""
        with self._lock:
            while self._next < len(self._order) and self._valid() + self._running < self._count:
                mutant = self._order[self._next]
                self._next += 1
                if mutant.key not in self._results.by_key or mutant.key in self._again:
                    self._running += 1
                    return mutant, False
            for mutant in self._order[:self._next]:
                if self._outcome(mutant) == WAITING and mutant.key not in self._handed:
                    self._handed.add(mutant.key)
                    return mutant, True
            return None

    def done(self, slow):
        with self._lock:
            self._running -= 0 if slow else 1

    def _outcome(self, mutant):
        return self._results.by_key.get(mutant.key, {}).get("outcome")

    def _valid(self):
        return sum(result["outcome"] in (KILLED, SURVIVED, WAITING) for result in self.known())

    def known(self):
        """Results of the part of the order that was reached, as the sources are now."""
        found = (self._results.by_key.get(mutant.key) for mutant in self._order[:self._next])
        return [result for result in found if result]


def work_through(number, base, times, sample, results, failures):
    try:
        worker = Worker(base, times, WORK / f"worker{number}")
        for result in list(results.by_key.values()):
            if result["outcome"] == KILLED:
                worker.learn(result["file"], result["by"])
        while (taken := sample.take()) is not None:
            mutant, slow = taken
            try:
                result = results.add(mutant, worker.judge(mutant, slow))
            finally:
                sample.done(slow)
            print(f"{result['outcome']} {mutant.file}:{mutant.line} {result['by']} ({result['seconds']} s)", flush=True)
    except (BrokenTests, OSError, subprocess.CalledProcessError) as error:
        failures.append(str(error))


def run(sample, results, files, workers):
    base = Base(ROOT, WORK / "base")
    needed = {check for file in files for check in checks.checks_of(file)}
    base.prepare(sorted({check.target for check in needed}))
    times, failures = Times(base, print), []
    times.measure(needed)
    threads = [threading.Thread(target=work_through, args=(number, base, times, sample, results, failures))
               for number in range(workers)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for failure in failures:
        print(f"mutate.sh: {failure}", file=sys.stderr)
    return not failures




def write_page(known, argued, generated, seed):
    text = PAGE.read_text()
    head = text[:text.index("<!-- results -->")]
    commit = subprocess.run(["git", "rev-parse", "--short=10", "HEAD"], cwd=ROOT, check=True, capture_output=True,
                            text=True).stdout.strip()
    valid = sum(result["outcome"] in (KILLED, SURVIVED, WAITING) for result in known)
    opening = (f"<!-- results -->\n\nCommit {commit}, seed {seed}: {len(known):,} of {generated:,} generated mutants "
               f"were tried; {valid} of them compile and change the machine code.\n")
    if valid < GOAL:
        opening += f"\nThe run is not complete: `scripts/mutate.sh` continues it up to {GOAL}.\n"
    PAGE.write_text(head + report.page(known, argued, opening))


def stop(signal_number, _):
    checks.stop_all()
    os._exit(128 + signal_number)


def main():
    given = options()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, stop)
    os.chdir(ROOT)
    given.results.parent.mkdir(parents=True, exist_ok=True)
    files = given.only or mutants.sources(ROOT)
    order = mutants.in_order(ROOT, given.seed, files)
    results, argued = Results(given.results), report.Argued(ARGUED)
    if given.report:
        known = [results.by_key[mutant.key] for mutant in order if mutant.key in results.by_key]
        write_page(known, argued, len(order), given.seed)
        return 0
    print(f"{len(order):,} mutants of {len(files)} files; {len(results.by_key)} known", flush=True)
    sample = Sample(order, results, given.count, given.again)
    try:
        if not run(sample, results, files, given.workers):
            return 1
    except BrokenTests as error:
        print(f"mutate.sh: {error}", file=sys.stderr)
        return 1
    known = sample.known()
    print("\n".join(report.table(known, argued)))
    return 0 if report.enough_killed(known, argued) else 1


if __name__ == "__main__":
    sys.exit(main())
