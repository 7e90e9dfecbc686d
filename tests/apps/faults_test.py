"""Tests of the program on a failing machine: outputs are complete or absent, and errors are reported.
usage: faults_test.py MIEN FAILING_MALLOC [all]      all: every allocation fails once, which takes minutes"""
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MIEN, FAILING_MALLOC = sys.argv[1:3]
EVERY_ALLOCATION = "all" in sys.argv[3:]
ALLOCATIONS_TRIED = 60
SOURCE = pathlib.Path(__file__).resolve().parents[2]
OUTPUT_FAILED, TRUNCATED, NO_VIDEO, NO_INPUT, NO_SOUND, INTERNAL = 7, 5, 4, 3, 11, 1
WIDTH, HEIGHT, FRAMES = 64, 48, 40


def clip() -> bytes:
    """Y4M without a face."""
    frames = b"".join(b"FRAME\n" + bytes((x * y + n) % 256 for y in range(HEIGHT) for x in range(WIDTH))
                      + bytes([128]) * (WIDTH * HEIGHT // 2) for n in range(FRAMES))
    return f"YUV4MPEG2 W{WIDTH} H{HEIGHT} F30:1 C420jpeg\n".encode() + frames


class Faults(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.clip = self.folder / "clip.y4m"
        self.clip.write_bytes(clip())

    def arguments(self, *more, source=None):
        return [MIEN, "track", str(source or self.clip), "--quiet", "--lod", "1", "--mode", "video",
                "--models", str(SOURCE / "models"), *map(str, more)]

    def mien(self, *more, source=None, **options):
        return subprocess.run(self.arguments(*more, source=source), capture_output=True, timeout=120, **options)

    def whole(self) -> bytes:
        done = self.mien()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count(b"\n"), FRAMES + 1)
        return done.stdout

    def assert_no_output(self, name="out.csv"):
        self.assertEqual([path.name for path in self.folder.iterdir() if name in path.name], [])

    def test_full_disk_leaves_no_output(self):
        """A limit on file sizes simulates a full disk."""
        whole = len(self.whole())
        for limit in (0, 1, 4096, whole - 1):
            def small_disk(limit=limit):
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            failed = self.mien("-o", self.folder / "out.csv", preexec_fn=small_disk)
            self.assertEqual(failed.returncode, OUTPUT_FAILED, limit)
            self.assertEqual(failed.stderr.count(b"\n"), 1, failed.stderr)
            self.assert_no_output()

    def test_full_device_as_standard_output(self):
        with open("/dev/full", "wb") as full:
            failed = subprocess.run(self.arguments(), stdout=full, stderr=subprocess.PIPE, timeout=120)
        self.assertEqual(failed.returncode, OUTPUT_FAILED)
        self.assertIn(b"standard output", failed.stderr)

    def test_a_device_is_not_replaced(self):
        """Replacing /dev/null by a file would break the whole machine."""
        self.assertEqual(self.mien("-o", "/dev/null").returncode, 0)
        self.assertTrue(pathlib.Path("/dev/null").is_char_device())
        self.assertEqual(list(pathlib.Path("/dev").glob(".partial*")), [])

    def test_a_closed_reader_ends_the_program(self):
        """More frames than a pipe holds, so that the writer notices."""
        endless = self.folder / "long.y4m"
        head, _, frames = clip().partition(b"\n")
        endless.write_bytes(head + b"\n" + frames * 40)
        began = time.monotonic()
        process = subprocess.Popen(self.arguments(source=endless), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.readline()
        process.stdout.close()
        errors = process.stderr.read()
        process.stderr.close()
        self.assertEqual((process.wait(timeout=120), errors), (0, b""), "a closed reader is not an error")
        self.assertLess(time.monotonic() - began, 100)

    def test_short_reads_and_interruptions_change_nothing(self):
        """Small writes to a pipe while the process is stopped and continued: read and poll return early."""
        expected, dice = self.whole(), random.Random(1)
        process = subprocess.Popen(self.arguments("-o", self.folder / "out.csv", source="-"), stdin=subprocess.PIPE)
        rest = clip()
        while rest:
            size = dice.choice((1, 7, 100, 4096, 60000))
            process.stdin.write(rest[:size])
            process.stdin.flush()
            rest = rest[size:]
            if dice.random() < 0.2:
                process.send_signal(signal.SIGSTOP)
                process.send_signal(signal.SIGCONT)
        process.stdin.close()
        self.assertEqual(process.wait(timeout=120), 0)
        self.assertEqual((self.folder / "out.csv").read_bytes(), expected)

    def test_input_that_ends_anywhere_leaves_no_output(self):
        whole, dice = clip(), random.Random(2)
        frame = len(b"FRAME\n") + WIDTH * HEIGHT * 3 // 2
        head = whole.index(b"\n") + 1
        for _ in range(15):
            cut = dice.randrange(1, len(whole))
            if cut >= head and (cut - head) % frame == 0:
                continue  # a shorter but complete video
            failed = self.mien("-o", self.folder / "out.csv", source="-", input=whole[:cut])
            self.assertIn(failed.returncode, (TRUNCATED, NO_VIDEO), cut)
            self.assert_no_output()

    def test_unreadable_input_is_an_error(self):
        """/proc/self/mem can be opened but not read at offset 0, like a file on a damaged disk."""
        failed = subprocess.run([MIEN, "convert", "/proc/self/mem", str(self.folder / "out.csv")], capture_output=True, timeout=120)
        self.assertEqual(failed.returncode, NO_INPUT)
        self.assertEqual(failed.stderr, b"mien: /proc/self/mem: read error before the end of the file\n")
        self.assert_no_output()

    def test_killed_at_any_moment_outputs_are_whole_or_absent(self):
        whole, dice = self.whole(), random.Random(3)
        out = self.folder / "out.csv"
        began = time.monotonic()
        self.mien("-o", out)
        usual = time.monotonic() - began
        out.unlink()
        killed = 0
        for _ in range(20):
            process = subprocess.Popen(self.arguments("-o", out, "--landmarks", self.folder / "landmarks.csv"))
            time.sleep(dice.uniform(0, 1.2 * usual))
            process.kill()
            killed += process.wait() == -signal.SIGKILL
            if out.exists():
                self.assertEqual(out.read_bytes(), whole)
                out.unlink()
        self.assertGreater(killed, 3, "most should have been killed in the middle")
        self.assertEqual(self.mien("-o", out).returncode, 0, "leftovers do not disturb the next run")
        self.assertEqual(out.read_bytes(), whole)

    def test_a_killed_batch_continues(self):
        whole, dice = self.whole(), random.Random(4)
        clips, out = self.folder / "clips", self.folder / "curves"
        clips.mkdir()
        names = [f"{n}.y4m" for n in range(6)]
        for name in names:
            shutil.copy(self.clip, clips / name)
        batch = self.arguments("--out", out, "--jobs", 2, source=clips)
        began = time.monotonic()
        subprocess.run(batch, check=True, capture_output=True, timeout=120)
        usual = time.monotonic() - began
        halves = 0
        for _ in range(10):
            shutil.rmtree(out)
            process = subprocess.Popen(batch, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(dice.uniform(0.2, 1) * usual)
            process.kill()
            process.wait()
            done = {path: path.stat().st_mtime_ns for path in out.glob("[!.]*")}
            halves += 0 < len(done) < len(names)
            for path in done:
                self.assertEqual(path.read_bytes(), whole)
            again = subprocess.run(batch, capture_output=True, timeout=120)
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual(sorted(path.name for path in out.iterdir()), [f"{name}.csv" for name in names])
            for path in out.iterdir():
                self.assertEqual(path.read_bytes(), whole)
                self.assertEqual(path.stat().st_mtime_ns, done.get(path, path.stat().st_mtime_ns), "done once")
        self.assertGreater(halves, 0, "some should have been killed in the middle")

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_a_decoder_that_dies_leaves_no_output(self):
        """ffmpeg decodes a part of the video, then is killed, fails, or exits."""
        real = shutil.which("ffmpeg")
        fakes = self.folder / "bin"
        fakes.mkdir()
        for ending in ("kill -9 $$", "kill -11 $$", "exit 1", "exit 0"):
            fake = fakes / "ffmpeg"
            fake.write_text(f'#!/bin/sh\n"{real}" "$@" 2>/dev/null | head -c 2000000\n{ending}\n')
            fake.chmod(0o755)
            failed = self.mien("-o", self.folder / "out.csv", source=SOURCE / "tests/data/demo.mp4",
                               env={**os.environ, "PATH": f"{fakes}:{os.environ['PATH']}"})
            self.assertEqual(failed.returncode, TRUNCATED, (ending, failed.stderr))
            self.assert_no_output()

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_an_encoder_that_dies_leaves_no_output(self):
        real = shutil.which("ffmpeg")
        fakes = self.folder / "bin"
        fakes.mkdir()
        fake = fakes / "ffmpeg"
        fake.write_text(f'#!/bin/sh\ncase "$*" in *rgb24*-y*|*-y*rgb24*) head -c 100000 >/dev/null; kill -9 $$ ;; esac\n'
                        f'exec "{real}" "$@"\n')
        fake.chmod(0o755)
        failed = self.mien("-o", self.folder / "out.csv", "--overlay", self.folder / "out.csv.mp4",
                           env={**os.environ, "PATH": f"{fakes}:{os.environ['PATH']}"})
        self.assertEqual(failed.returncode, OUTPUT_FAILED, failed.stderr)
        self.assert_no_output()

    @unittest.skipUnless(FAILING_MALLOC != "-", "the sanitizers' heap cannot be replaced")
    def test_the_nth_allocation_fails(self):
        """For every n, the program exits by itself, with a complete output or none."""
        out, count = self.folder / "out", self.folder / "count"
        model = SOURCE / "models/proposal.mien"
        verbs = {"inspect": [MIEN, "inspect", str(model)], "track": self.arguments("-o", out, "--duration", "0.2")}
        for verb, arguments in verbs.items():
            environment = {**os.environ, "LD_PRELOAD": FAILING_MALLOC}
            done = subprocess.run(arguments, capture_output=True, timeout=120,
                                  env={**environment, "MIEN_COUNT_TO": str(count)})
            self.assertEqual(done.returncode, 0, done.stderr)
            whole = out.read_bytes() if verb == "track" else done.stdout
            total = int(count.read_text())
            self.assertGreater(total, 100)
            step = 1 if EVERY_ALLOCATION else max(1, total // ALLOCATIONS_TRIED)
            for n in range(1, total + 1, step):
                out.unlink(missing_ok=True)
                failed = subprocess.run(arguments, capture_output=True, timeout=120,
                                        env={**environment, "MIEN_FAIL_AT": str(n)})
                self.assertIn(failed.returncode, (0, INTERNAL, 2, 3, 7, 8), (verb, n, failed.stderr))
                if failed.returncode == 0:
                    self.assertEqual(out.read_bytes() if verb == "track" else failed.stdout, whole, (verb, n))
                else:
                    self.assertFalse(out.exists(), (verb, n))


if __name__ == "__main__":
    if not (SOURCE / "models/basenet.mien").exists():
        print("skipped: the weights are missing")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
