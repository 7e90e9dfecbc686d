"""The tests that run on mutants of a folder: those nearest to it."""
import contextlib
import dataclasses
import os
import re
import resource
import signal
import subprocess

FRAMES = "300"  # of a test's random animations; more find no further mutants
MEMORY = 4 << 30  # bytes; a mutant may ask for any amount


@dataclasses.dataclass(frozen=True)
class Check:
    """A test program, or a Python test of it (`script`) with arguments after the program."""
    target: str
    path: str
    script: str = ""
    arguments: tuple = ()


def program(folder, name):
    return Check(name, f"tests/{folder}/{name}")


FORMATS = program("formats", "formats_test")
ANIMATION = program("apps/animation", "animation_test")
ENGINE = [program("engine", "engine_test"), program("engine", "engine_allocation_test"),
          program("engine", "engine_stack_test")]
API = [program("api", "api_test"), program("api", "api_stack_test")]
AUDIO = program("audio", "audio_test")
GEOMETRY = program("tracker", "tracker_geometry_test")
TRACKER = program("tracker", "tracker_test")
TRACKER_TESTS = [program("tracker", f"tracker_{n}_test") for n in ("threads", "allocation", "scenario", "trained")]
COMPARE = program("apps", "compare_test")
CONVERT = Check("mien_program", "apps/mien/mien", "tests/apps/convert_test.py", (FRAMES,))
CONVERT_GLTF = Check("mien_program", "apps/mien/mien", "tests/apps/convert_gltf_test.py", (FRAMES,))
PROTOCOLS = Check("protocol_packets", "tests/apps/protocols/protocol_packets",
                  "tests/apps/protocols/protocols_test.py", (FRAMES,))

# By folder, the longest name that fits; the nearest tests first.
PLAN = {
    "apps/protocols": [PROTOCOLS],
    "apps/animation": [ANIMATION, CONVERT, CONVERT_GLTF, COMPARE],
    "formats": [FORMATS, CONVERT, CONVERT_GLTF, *ENGINE, *API],
    "engine": [*ENGINE, *API, AUDIO, GEOMETRY, TRACKER, *TRACKER_TESTS],
    "audio": [AUDIO, TRACKER, *TRACKER_TESTS],
    "tracker": [GEOMETRY, *API, TRACKER, *TRACKER_TESTS],
}


def checks_of(file):
    return PLAN[max((folder for folder in PLAN if file.startswith(folder + "/")), key=len)]


def is_near(file, test):
    """Whether they have a word of their names in common."""
    words = os.path.splitext(os.path.basename(file))[0].split("_")
    return any(len(word) > 2 and word in test.lower().replace("_", "") for word in words)


running = set()


def stop_all():
    for process in list(running):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


def run(command, seconds, folder):
    """(exit status or "timeout", output). `seconds` of a processor: how busy the machine is does not matter."""
    limits = ["prlimit", f"--cpu={int(seconds)}", f"--as={MEMORY}", "--core=0"]
    with subprocess.Popen([*limits, *command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, cwd=folder, start_new_session=True) as process:
        running.add(process)
        try:
            output, _ = process.communicate(timeout=20 * seconds)
            return process.returncode, output.decode(errors="replace")
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
            return "timeout", output.decode(errors="replace")
        finally:
            running.discard(process)


def command(check, path, source, tests):
    if check.script:
        return ["/usr/bin/python3", "-B", str(source / check.script), str(path), *check.arguments, "-f", *tests]
    return [str(path), "--gtest_fail_fast", f"--gtest_filter={':'.join(tests)}"]


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def names(check, path, source):
    """The names of the check's tests."""
    if check.script:
        found = re.findall(r"^class (\w+)|^    def (test\w+)", (source / check.script).read_text(), re.MULTILINE)
        suite, tests = "", []
        for class_name, test in found:
            suite = class_name or suite
            tests += [f"{suite}.{test}"] if test else []
        return tests
    done = subprocess.run([path, "--gtest_list_tests"], check=True, capture_output=True, text=True)
    suite, tests = "", []
    for line in done.stdout.splitlines()[1:]:
        if line.startswith("  "):
            tests.append(suite + line.split("#")[0].strip())
        else:
            suite = line.split("#")[0].strip()
    return tests


def first_failure(check, output):
    """The test that noticed."""
    if check.script:
        found = re.search(r"^(?:FAIL|ERROR): (\w+) \((?:__main__\.)?(\w+)", output, re.MULTILINE)
        return f"{found[2]}.{found[1]}" if found else f"{check.script} (it stops)"
    found = re.search(r"^\[  FAILED  \] (\S+?),? .*\(\d+ ms\)$", output, re.MULTILINE)
    if found:
        return found[1]
    begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
    return f"{begun[-1] if begun else check.target} (it crashes or never ends)"
