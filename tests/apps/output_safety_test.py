"""Tests of outputs while other processes write the same file, and while signals end the program.

usage: output_safety_test.py MIEN [full] [TEST]...      full: 1,000 pairs of processes, and 200 runs per signal, which take half an hour
"""
import base64
import collections
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MIEN = sys.argv[1]
FULL = "full" in sys.argv[2:]
PAIRS, KILLS = (1000, 200) if FULL else (12, 8)
SOURCE = pathlib.Path(__file__).resolve().parents[2]
WIDTH, HEIGHT = 64, 48
HAVE_FFMPEG = shutil.which("ffmpeg") is not None


def clip(frames: int, shift: int = 0) -> bytes:
    """Y4M without a face."""
    made = b"".join(b"FRAME\n" + bytes((x * y + n + shift) % 256 for y in range(HEIGHT) for x in range(WIDTH))
                    + bytes([128]) * (WIDTH * HEIGHT // 2) for n in range(frames))
    return f"YUV4MPEG2 W{WIDTH} H{HEIGHT} F30:1 C420jpeg\n".encode() + made


def processes_that_name(folder: pathlib.Path) -> list[str]:
    """Surviving children of the program (Linux only)."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            command = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if str(folder) in command and "output_safety_test" not in command:
            found.append(command)
    return found


def has_unnamed_files(folder: pathlib.Path) -> bool:
    """Whether the file system has files that disappear with their process."""
    try:
        os.close(os.open(folder, os.O_TMPFILE | os.O_RDWR))
    except (AttributeError, OSError):
        return False
    return True


class OutputSafety(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.inputs = self.folder / "inputs"
        self.out = self.folder / "out"
        self.inputs.mkdir()
        self.out.mkdir()
        self.dice = random.Random(40)

    def track(self, source, *more):
        return [MIEN, "track", str(source), "--quiet", "--lod", "1", "--mode", "video", "--models", str(SOURCE / "models"), *map(str, more)]

    def files(self) -> list[str]:
        return sorted(path.name for path in self.out.iterdir())

    def run_to_end(self, command) -> float:
        began = time.monotonic()
        done = subprocess.run(command, capture_output=True, timeout=300)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return time.monotonic() - began

    def race(self, name, commands, pairs):
        """The last process to end determines the file."""
        out = self.out / name
        whole = []
        for command in commands:
            self.run_to_end(command)
            whole.append(out.read_bytes())
            out.unlink()
        self.assertNotEqual(*whole)
        winners = collections.Counter()
        for i in range(pairs):
            order = self.dice.sample(commands, 2)
            first = subprocess.Popen(order[0], stderr=subprocess.PIPE)
            time.sleep(self.dice.choice((0, 0, 0.002, 0.01)))
            second = subprocess.Popen(order[1], stderr=subprocess.PIPE)
            for process in (first, second):
                self.assertEqual((process.communicate(timeout=300)[1], process.returncode), (b"", 0))
            content = out.read_bytes()
            self.assertIn(content, whole, f"{name}: not the output of either process, pair {i}")
            winners[whole.index(content)] += 1
            self.assertEqual(self.files(), [name])
            if self.dice.random() < 0.5:
                out.unlink()
        return winners

    def test_two_processes_with_one_output(self):
        clips = [self.inputs / "a.y4m", self.inputs / "b.y4m"]
        for shift, path in enumerate(clips):
            path.write_bytes(clip(30 + shift, shift))
        curves = [self.inputs / "a.csv", self.inputs / "b.csv"]
        for source, table in zip(clips, curves):
            self.run_to_end(self.track(source, "-o", table))
        races = {
            "out.csv": [self.track(path, "-o", self.out / "out.csv") for path in clips],
            "out.glb": [[MIEN, "convert", "--quiet", path, self.out / "out.glb"] for path in curves],
        }
        if HAVE_FFMPEG:  # a nameless temporary video, and one with a temporary name
            for name in ("out.mp4", "out.nut"):
                races[name] = [self.track(path, "-o", os.devnull, "--overlay", self.out / name) for path in clips]
        share = {"out.csv": 0.4, "out.glb": 0.4, "out.mp4": 0.1, "out.nut": 0.1}
        total = sum(share[name] for name in races)
        counts = {name: round(PAIRS * share[name] / total) for name in races}
        for name, commands in races.items():
            winners = self.race(name, commands, counts[name])
            self.assertEqual(sum(winners.values()), counts[name])
            (self.out / name).unlink(missing_ok=True)
            print(f"{name}: {counts[name]} pairs, all whole; first, second: {winners[0]}, {winners[1]}")

    def outputs(self):
        made = ["-o", self.out / "out.csv", "--landmarks", self.out / "landmarks.csv", "--stats", self.out / "stats.json"]
        if HAVE_FFMPEG:
            made += ["--overlay", self.out / f"out.{self.dice.choice(('mp4', 'nut'))}", "--report", self.out / "report.html"]
        return made

    def assert_whole_or_absent(self, whole):
        for path in self.out.iterdir():
            content = path.read_bytes()
            if path.suffix == ".json":
                json.loads(content)
            elif path.suffix == ".html":
                self.assertTrue(content.rstrip().endswith(b"</html>"))
            else:
                self.assertEqual(content, whole[path.name], path.name)

    def end_after(self, seconds, number, command, whole):
        """In half of the runs the whole process group gets the signal, as from a terminal."""
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)
        time.sleep(seconds)
        if self.dice.random() < 0.5:
            os.killpg(process.pid, number)
        else:
            process.send_signal(number)
        process.communicate(timeout=300)
        known = set(whole) | {"stats.json", "report.html"}
        self.assertLessEqual(set(self.files()), known, "leftover files")
        self.assert_whole_or_absent(whole)
        self.assertEqual(processes_that_name(self.folder), [])
        return process.returncode

    def check_signal(self, number):
        source = self.inputs / "clip.y4m"
        source.write_bytes(clip(20))
        whole, usual = {}, 0.0
        for _ in range(4):  # both kinds of temporary video
            usual = self.run_to_end(self.track(source, *self.outputs()))
            whole.update({path.name: path.read_bytes() for path in self.out.iterdir() if path.suffix not in (".json", ".html")})
        ends = collections.Counter()
        for _ in range(KILLS):
            for path in self.out.iterdir():
                if self.dice.random() < 0.7:  # existing files are replaced, or stay complete
                    path.unlink()
            seconds = self.dice.uniform(0, 1.2 * usual)
            end = self.end_after(seconds, number, self.track(source, *self.outputs()), whole)
            ends[end] += 1
            if end == 0:  # includes the last moments of a run, however busy the machine is
                usual *= 0.97
            elif seconds > usual:
                usual *= 1.1
        self.assertLessEqual(set(ends), {0, -number}, ends)
        self.assertGreater(ends[-number], KILLS // 3, "most should have been ended in the middle")
        print(f"{number.name}: {KILLS} runs, {ends[-number]} ended by it, nothing left behind")

    def test_sigint_leaves_nothing_behind(self):
        self.check_signal(signal.SIGINT)

    def test_sigterm_leaves_nothing_behind(self):
        self.check_signal(signal.SIGTERM)

    def test_sighup_leaves_nothing_behind(self):
        self.check_signal(signal.SIGHUP)

    def test_an_ignored_signal_stays_ignored(self):
        """As under nohup."""
        source = self.inputs / "clip.y4m"
        source.write_bytes(clip(20))
        usual = self.run_to_end(self.track(source, "-o", self.out / "out.csv"))
        process = subprocess.Popen(self.track(source, "-o", self.out / "out.csv"),
                                   preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        time.sleep(usual / 2)
        process.send_signal(signal.SIGHUP)
        self.assertEqual(process.wait(timeout=300), 0)

    def test_kill_9_leaves_nothing_if_the_file_system_supports_it(self):
        if not has_unnamed_files(self.out):
            self.skipTest("no nameless files on this file system")
        source = self.inputs / "clip.y4m"
        source.write_bytes(clip(20))
        command = self.track(source, "-o", self.out / "out.csv", "--landmarks", self.out / "landmarks.csv",
                             *(["--overlay", self.out / "out.mp4"] if HAVE_FFMPEG else []))
        usual = self.run_to_end(command)
        whole = {path.name: path.read_bytes() for path in self.out.iterdir()}
        for _ in range(KILLS):
            for path in self.out.iterdir():
                path.unlink()
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(self.dice.uniform(0, 1.1 * usual))
            process.kill()
            process.wait()
            self.assertLessEqual(set(self.files()), set(whole))
            self.assert_whole_or_absent(whole)

    def test_a_prepared_link_is_not_followed(self):
        """Links have the names that temporary files used to have, and that of the output."""
        source, victim = self.inputs / "clip.y4m", self.folder / "victim"
        source.write_bytes(clip(3))
        victim.write_text("mine")
        for name in (".partial-out.csv", "out.csv"):
            (self.out / name).symlink_to(victim)
        self.run_to_end(self.track(source, "-o", self.out / "out.csv"))
        self.assertEqual(victim.read_text(), "mine")
        self.assertFalse((self.out / "out.csv").is_symlink())
        self.assertTrue((self.out / ".partial-out.csv").is_symlink())

    def test_mode_of_a_replaced_file(self):
        source = self.inputs / "clip.y4m"
        source.write_bytes(clip(3))
        names = ["out.csv", *(["out.mp4", "out.nut"] if HAVE_FFMPEG else [])]
        for name in names:
            (self.out / name).write_text("before")
            (self.out / name).chmod(0o640)
        self.run_to_end(self.track(source, "-o", self.out / "out.csv"))
        for name in names[1:]:
            self.run_to_end(self.track(source, "-o", os.devnull, "--overlay", self.out / name))
        for name in names:
            self.assertEqual((self.out / name).stat().st_mode & 0o777, 0o640, name)
            self.assertNotEqual((self.out / name).read_bytes(), b"before")


class SameFile(unittest.TestCase):
    """No verb overwrites its input."""

    WRONG_USAGE = 2

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.clip = self.folder / "clip.y4m"
        self.clip.write_bytes(clip(3))
        self.curves = self.folder / "curves.csv"
        subprocess.run([MIEN, "track", self.clip, "--quiet", "--lod", "1", "-o", self.curves, "--models", SOURCE / "models"], check=True)
        self.models = self.folder / "models"
        shutil.copytree(SOURCE / "models", self.models)
        self.array = self.folder / "array.npy"
        self.array.write_bytes(b"\x93NUMPY\x01\x00")

    def names_of(self, path):
        """Its own name, a link, a link to a link, a hard link."""
        link, again, hard = (self.folder / f"{name}{path.suffix}" for name in ("link", "again", "hard"))
        link.symlink_to(path)
        again.symlink_to(link)
        os.link(path, hard)
        yield from (path, link, again, hard)
        for one in (link, again, hard):
            one.unlink()

    def assert_rejected(self, path, *command):
        before = {file: file.read_bytes() for file in self.folder.rglob("*") if file.is_file()}
        for name in self.names_of(path):
            done = subprocess.run([MIEN, *(str(name if word is path else word) for word in command)], capture_output=True, timeout=120)
            self.assertEqual(done.returncode, self.WRONG_USAGE, (command, name, done.stderr))
            self.assertIn(b"the output is the same file as the input", done.stderr)
            self.assertEqual(done.stderr.count(b"\n"), 1)
        self.assertEqual({file: file.read_bytes() for file in before}, before)
        self.assertEqual([file for file in self.folder.rglob("*") if file.is_file() and file not in before], [])

    def test_track(self):
        quietly = ("--quiet", "--lod", "1", "--models", self.models)
        target = pathlib.Path(str(self.clip))  # differs from the input, which is renamed
        for option in ("-o", "--landmarks", "--overlay", "--report", "--stats"):
            more = ("--format", "csv") if option == "-o" else ()
            self.assert_rejected(target, "track", self.clip, option, target, *more, *quietly)
        weights = self.models / "basenet.mien"
        self.assert_rejected(weights, "track", self.clip, "-o", weights, "--format", "csv", *quietly)

    def test_the_clip_beside_a_report(self):
        video = self.folder / "page.mp4"
        shutil.copy(SOURCE / "tests/data/demo.mp4", video)
        done = subprocess.run([MIEN, "track", video, "--quiet", "--duration", "0.1", "--report", self.folder / "page", "--models", self.models],
                              capture_output=True, timeout=120)
        self.assertEqual(done.returncode, self.WRONG_USAGE if HAVE_FFMPEG else 6, done.stderr)

    def test_neutral(self):
        target = pathlib.Path(str(self.clip))
        self.assert_rejected(target, "neutral", self.clip, "-o", target, "--models", self.models)
        weights = self.models / "proposal.mien"
        self.assert_rejected(weights, "neutral", self.clip, "-o", weights, "--models", self.models)

    def test_convert(self):
        target = pathlib.Path(str(self.curves))
        self.assert_rejected(target, "convert", self.curves, target)
        notes = self.folder / "curves.csv.json"
        notes.write_text("{}")
        self.assert_rejected(notes, "convert", self.curves, notes, "--to", "csv")

    def test_a_file_referenced_by_the_input(self):
        scene, numbers = self.folder / "scene.gltf", self.folder / "scene.bin"
        subprocess.run([MIEN, "convert", "--quiet", self.curves, scene], check=True)
        document = json.loads(scene.read_text())
        numbers.write_bytes(base64.b64decode(document["buffers"][0]["uri"].partition(",")[2]))
        document["buffers"][0]["uri"] = numbers.name
        scene.write_text(json.dumps(document))
        if b"is not supported" in subprocess.run([MIEN, "convert", "--quiet", scene, self.folder / "new.csv"], capture_output=True).stderr:
            self.skipTest("the program reads no referenced files")
        (self.folder / "new.csv").unlink()
        self.assert_rejected(numbers, "convert", scene, numbers, "--to", "csv")

    def test_compare(self):
        other = self.folder / "other.csv"
        shutil.copy(self.curves, other)
        for table in (self.curves, other):
            target = pathlib.Path(str(table))
            self.assert_rejected(target, "compare", self.curves, other, "-o", target)
        video = pathlib.Path(str(self.clip))
        self.assert_rejected(video, "compare", self.curves, other, "--video", self.clip, "-o", video)

    def test_run(self):
        weights = self.models / "proposal.mien"
        for target in (pathlib.Path(str(self.array)), pathlib.Path(str(weights))):
            self.assert_rejected(target, "run", weights, "--input", self.array, "--network", "rnet", "--output", self.folder / "b.npy",
                                 "--output", target)

    def test_standard_streams(self):
        """`mien convert - - < x >> x` would read its own output."""
        with open(self.curves, "rb") as source, open(self.curves, "ab") as target:
            done = subprocess.run([MIEN, "convert", "-", "-"], stdin=source, stdout=target, stderr=subprocess.PIPE, timeout=120)
        self.assertEqual(done.returncode, self.WRONG_USAGE, done.stderr)


if __name__ == "__main__":
    if not (SOURCE / "models/basenet.mien").exists():
        print("skipped: the weights are missing")
        sys.exit(77)
    tests = [word for word in sys.argv[2:] if word != "full"]
    unittest.main(argv=[sys.argv[0], *tests], verbosity=2)
