"""Builds mutants one by one and runs the tests until the first one fails."""
import json
import time

from . import checks
from .variant import NotCompiled, Variant

KILLED, SURVIVED = "killed", "survived"
WAITING = "waiting"  # for the slow tests: the quick ones pass
NOT_COMPILED, IDENTICAL = "not compiled", "identical"  # no mutants at all
QUICK_S = 0.1  # tests that take longer wait until the quick ones have seen all mutants
INSTANT_S = 0.03
LATEST_KILLERS = 12


class BrokenTests(Exception):
    """Tests fail without any mutant."""


class Times:
    """How long the tests of each check take without a mutant."""

    def __init__(self, base, log):
        self._base, self._log, self._times = base, log, {}

    def measure(self, needed):
        for check in sorted(needed, key=lambda check: (check.target, check.script)):
            self._times[check] = self._of(check)
            self._log(f"{check.target}: {len(self._times[check])} tests, {sum(self._times[check].values()):.1f} s")
        self._log(f"all tests: {sum(sum(times.values()) for times in self._times.values()):.0f} s of one processor")

    def __getitem__(self, check):
        return self._times[check]

    def _of(self, check):
        """Times from an earlier run, with new measurements of missing ones."""
        memory = self._base.build_folder / f"mutation_times_{check.target}.json"
        known = json.loads(memory.read_text())["times"] if memory.is_file() else {}
        path = self._base.build_folder / check.path
        names = checks.names(check, path, self._base.source)
        times = {test: known[test] if test in known else self._seconds(check, path, test) for test in names}
        memory.write_text(json.dumps({"times": {**known, **times}}))
        return times

    def _seconds(self, check, path, test):
        began = checks.processor_seconds()
        outcome, _ = checks.run(checks.command(check, path, self._base.source, [test]), 600, self._base.build_folder)
        if outcome != 0:
            raise BrokenTests(f"{check.target}: {test} fails without a mutant")
        return round(checks.processor_seconds() - began, 3)


class Worker:
    def __init__(self, base, times, folder):
        self._base, self._times, self._folder = base, times, folder
        self._variant, self._killers, self._sound = Variant(base, folder), {}, set()

    def learn(self, file, test):
        """That such tests noticed mutants of the file: they are run first."""
        test = test.split(" ")[0]
        known = self._killers.setdefault(file, [])
        if test in known:
            known.remove(test)
        known.insert(0, test)
        del known[LATEST_KILLERS:]

    def judge(self, mutant, slow):
        """By the quick tests or by the slow ones."""
        began = time.monotonic()
        outcome, test = self._outcome(mutant, slow)
        if outcome == KILLED:
            self.learn(mutant.file, test)
        return {"outcome": outcome, "by": test, "seconds": round(time.monotonic() - began, 1)}

    def _outcome(self, mutant, slow):
        text = mutant.applied((self._base.source / mutant.file).read_text())
        # Tests contain the inline code of headers: if the mutant of the library survives, they are compiled again.
        tests_too = slow and mutant.file.endswith(".h")
        jobs = [*(self._jobs(mutant.file, slow=False) if tests_too else []), *self._jobs(mutant.file, slow)]
        try:
            self._variant.begin(mutant.file, text, tests_too)
            programs = {}
            for check, tests in jobs:
                if check.path not in programs:
                    programs[check.path] = self._variant.program(check.path)
                if programs[check.path] is None:
                    continue
                failure = self._failure(check, programs[check.path], tests)
                if failure:
                    return KILLED, failure
            if not slow and self._variant.is_identical():
                return IDENTICAL, ""
        except NotCompiled:
            return NOT_COMPILED, ""
        return (SURVIVED if slow else WAITING), ""

    def _jobs(self, file, slow):
        """(check, tests): those that noticed mutants of this file, those named like it, then the others, the quickest
        first."""
        jobs = []
        for check in checks.checks_of(file):
            tests = [test for test, seconds in self._times[check].items() if (seconds > QUICK_S) == slow]
            ranks = {test: self._rank(file, test, self._times[check][test]) for test in tests}
            jobs += [(rank, check, [test for test in tests if ranks[test] == rank]) for rank in set(ranks.values())]
        jobs.sort(key=lambda job: job[0])
        return [(check, tests) for _, check, tests in jobs]

    def _rank(self, file, test, seconds):
        if test in self._killers.get(file, []):
            return (0, 0)
        far = not checks.is_near(file, test)
        if seconds > QUICK_S:
            return (2 + far, seconds)
        return (2, seconds > INSTANT_S) if far else (1, 0)

    def _failure(self, check, path, tests):
        outcome, output = self._run(check, path, tests)
        if outcome == 0:
            return ""
        failure = checks.first_failure(check, output)
        self._require_sound(check, failure.split(" ")[0])
        return failure

    def _run(self, check, path, tests):
        usual = sum(self._times[check][test] for test in tests)
        return checks.run(checks.command(check, path, self._base.source, tests), 10 + 5 * usual, self._folder)

    def _require_sound(self, check, test):
        """A failing test must pass without a mutant."""
        if test in self._sound or test not in self._times[check]:
            return
        if self._run(check, self._base.build_folder / check.path, [test])[0] != 0:
            raise BrokenTests(f"{check.target}: {test} fails without a mutant")
        self._sound.add(test)
