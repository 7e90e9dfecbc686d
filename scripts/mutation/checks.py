"""The tests that mutants of a folder face: those nearest to it, as they are run by ctest."""
import contextlib
import dataclasses
import json
import os
import re
import signal
import subprocess

FRAMES = "300"  # of a test's random animations: what depends on more of them is no fault of one line
SLOW_S = 1.0  # tests that take longer wait until all others have passed


@dataclasses.dataclass(frozen=True)
class Check:
    """A test program; `script`: a Python test of it, with the arguments behind the program."""
    target: str
    path: str
    script: str = ""
    arguments: tuple = ()


def program(folder, name):
    return Check(name, f"tests/{folder}/{name}")


FORMATS = program("formats", "formats_test")
ENGINE = [program("engine", "engine_test"), program("engine", "engine_allocation_test"), program("engine", "engine_stack_test")]
API = [program("api", "api_test"), program("api", "api_stack_test")]
AUDIO = program("audio", "audio_test")
GEOMETRY = program("tracker", "tracker_geometry_test")
TRACKER = program("tracker", "tracker_test")
OF_TRACKERS = [program("tracker", f"tracker_{name}_test") for name in ("threads", "allocation", "scenario", "trained")]
COMPARE = program("apps", "compare_test")
CONVERT = Check("mien_program", "apps/mien/mien", "tests/apps/convert_test.py", (FRAMES,))
PROTOCOLS = Check("protocol_packets", "tests/formats/protocol_packets", "tests/formats/protocols_test.py", (FRAMES,))

# By folder, the longest name that fits; the nearest tests first.
PLAN = {
    "formats/protocols": [PROTOCOLS],
    "formats/animation": [FORMATS, CONVERT, COMPARE],
    "formats": [FORMATS, CONVERT, *ENGINE, *API],
    "engine": [*ENGINE, *API, AUDIO, GEOMETRY, TRACKER, *OF_TRACKERS],
    "audio": [AUDIO, TRACKER, *OF_TRACKERS],
    "tracker": [GEOMETRY, *API, TRACKER, *OF_TRACKERS],
}


def checks_of(file):
    return PLAN[max((folder for folder in PLAN if file.startswith(folder + "/")), key=len)]


running = set()


def stop_all():
    for process in list(running):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


def run(command, seconds, folder):
    """(exit status or "timeout", output). At a timeout it also ends what the command started."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=folder, start_new_session=True) as process:
        running.add(process)
        try:
            output, _ = process.communicate(timeout=seconds)
            return process.returncode, output.decode(errors="replace")
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
            return "timeout", output.decode(errors="replace")
        finally:
            running.discard(process)


def command(check, tree, tests=None):
    path = str(tree.build_folder / check.path)
    if check.script:
        return ["/usr/bin/python3", str(tree.source / check.script), path, *check.arguments, "-f"]
    chosen = [f"--gtest_filter={':'.join(tests)}"] if tests else []
    return [path, "--gtest_fail_fast", *chosen]


def times(check, tree):
    """Seconds of each of its tests, all of which pass; None if one fails."""
    if check.script:
        outcome, output = run(command(check, tree), 3600, tree.build_folder)
        found = re.search(r"Ran \d+ tests? in ([\d.]+)s", output)
        return {check.script: float(found[1])} if outcome == 0 and found else None
    report = tree.build_folder / "mutation_times.json"
    outcome, _ = run([*command(check, tree), f"--gtest_output=json:{report}"], 3600, tree.build_folder)
    if outcome != 0:
        return None
    suites = json.loads(report.read_text())["testsuites"]
    return {f"{test['classname']}.{test['name']}": float(test["time"].rstrip("s")) for suite in suites for test in suite["testsuite"]
            if test["result"] == "COMPLETED"}


def first_failure(check, output):
    """The test that noticed."""
    if check.script:
        found = re.search(r"^(?:FAIL|ERROR): (\w+)", output, re.MULTILINE)
        return f"{check.script}: {found[1] if found else 'it stops'}"
    found = re.search(r"^\[  FAILED  \] (\S+?),? .*\(\d+ ms\)$", output, re.MULTILINE)
    if found:
        return found[1]
    begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
    return f"{begun[-1] if begun else check.target} (it crashes or never ends)"
