"""Builds mutants one by one and runs the tests until the first one fails."""
import json
import os
import time

from . import checks
from .tree import digest

KILLED, SURVIVED = "killed", "survived"
NOT_COMPILED, IDENTICAL = "not compiled", "identical"  # no mutants at all
LATEST_KILLERS = 12


class BrokenTests(Exception):
    """Tests fail without any mutant."""


class Worker:
    def __init__(self, tree, log):
        self._tree, self._log = tree, log
        self._hashes, self._times, self._killers = {}, {}, {}

    def prepare(self, files):
        """Builds and runs everything without a mutant."""
        self._tree.prepare()
        needed = {check for file in files for check in checks.checks_of(file)}
        if not self._tree.build(sorted({check.target for check in needed}), keep_in_cache=True):
            raise BrokenTests(f"the tests do not build: {self._tree.build_folder}/mutation_build.log")
        for file in files:
            self._hashes[file] = self._hash_objects(file)
        for check in sorted(needed, key=lambda check: (check.target, check.script)):
            self._hashes[check.path] = digest(self._tree.build_folder / check.path)
            self._times[check] = self._known_times(check)
            self._log(f"{check.target}: {len(self._times[check])} tests, {sum(self._times[check].values()):.0f} s")

    def _known_times(self, check):
        """From an earlier run where neither the program nor the script has changed since."""
        script = digest(self._tree.source / check.script) if check.script else ""
        memory = self._tree.build_folder / f"mutation_times_{check.target}.json"
        state = [self._hashes[check.path], script]
        if memory.is_file() and (known := json.loads(memory.read_text()))["state"] == state:
            return known["times"]
        times = checks.times(check, self._tree)
        if times is None:
            raise BrokenTests(f"{check.path} {check.script}: tests fail without a mutant")
        memory.write_text(json.dumps({"state": state, "times": times}))
        return times

    def learn(self, file, test):
        """That such tests noticed mutants of the file: they are run first."""
        known = self._killers.setdefault(file, [])
        if test in known:
            known.remove(test)
        known.insert(0, test)
        del known[LATEST_KILLERS:]

    def judge(self, mutant):
        began = time.monotonic()
        source = self._tree.read(mutant.file)
        self._tree.write(mutant.file, mutant.applied(source))
        try:
            outcome, test = self._outcome(mutant.file)
        finally:
            self._tree.write(mutant.file, source)
        if outcome == KILLED:
            self.learn(mutant.file, test)
        return {"outcome": outcome, "by": test, "seconds": round(time.monotonic() - began, 1)}

    def _hash_objects(self, file):
        return [digest(self._tree.build_folder / name) for name in self._tree.objects(file)
                if os.path.exists(self._tree.build_folder / name)]

    def _outcome(self, file):
        objects = [name for name in self._tree.objects(file) if os.path.exists(self._tree.build_folder / name)]
        if objects and not self._tree.build(objects, keep_in_cache=False):
            return NOT_COMPILED, ""
        if objects and self._hash_objects(file) == self._hashes[file]:
            return IDENTICAL, ""
        changed = set()
        for check, tests in self._jobs(file):
            if not self._tree.build([check.target], keep_in_cache=False):
                return NOT_COMPILED, ""
            if digest(self._tree.build_folder / check.path) == self._hashes[check.path]:
                continue
            changed.add(check.path)
            failure = self._failure(check, tests)
            if failure:
                return KILLED, failure
        return (SURVIVED, "") if changed else (IDENTICAL, "")

    def _jobs(self, file):
        """(check, tests): those that noticed mutants of this file, then the fast ones, then the slow ones."""
        plan = checks.checks_of(file)
        killers = self._killers.get(file, [])
        first, fast, slow = [], [], []
        for check in plan:
            times = self._times[check]
            known = [test for test in killers if test in times]
            slow_ones = [test for test in times if times[test] > checks.SLOW_S and test not in known]
            rest = [test for test in times if test not in slow_ones and test not in known]
            first += [(check, known)] if known else []
            fast += [(check, rest)] if rest else []
            slow += [(check, [test]) for test in sorted(slow_ones, key=times.get)]
        return first + fast + sorted(slow, key=lambda job: self._times[job[0]][job[1][0]])

    def _failure(self, check, tests):
        usual = sum(self._times[check][test] for test in tests)
        outcome, output = checks.run(checks.command(check, self._tree, tests), 60 + 10 * usual, self._tree.build_folder)
        return "" if outcome == 0 else checks.first_failure(check, output)
