"""Tests of the program built for Windows, under Wine, against the program of this machine.

usage: windows_test.py MIEN_EXE MIEN FOLDER_OF_FFMPEG_EXE          scripts/cross/windows.sh
"""
import base64
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import report_page
from datagrams import Receiver

EXE, MIEN, FFMPEG = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
MODELS = str(SOURCE / "models")
CLIP = str(SOURCE / "tests/data/demo.mp4")
# Controls are 0 to 1, angles in radians, positions in metres. For equal images only the C libraries differ.
SAME_PICTURES = 1e-4
# Two versions of ffmpeg, which may convert YUV to RGB differently; 1.1e-5 was measured.
OTHER_FFMPEG = 1e-3
# Windows does not permit < > : " | ? * \ or control characters in names.
NAMES = ["two words.mp4", "-clip.mp4", "--help.mp4", "Ünï 顔 😀.mp4", "it's 50%d (1) & more ^.mp4", "[0v],x=y;.mp4", "%PATH%.mp4"]


def environment(path):
    return dict(os.environ, WINEDEBUG="-all", LC_ALL="C.UTF-8", WINEPATH="Z:" + path.replace("/", "\\"))


def windows(*arguments, path=FFMPEG, **more):
    """Uses files, not pipes, because Wine's own processes keep pipes open."""
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        done = subprocess.run(["wine", EXE, *arguments], stdout=output, stderr=errors, timeout=300, env=environment(path), **more)
        output.seek(0)
        errors.seek(0)
        return subprocess.CompletedProcess(done.args, done.returncode, output.read(), errors.read())


def here(*arguments):
    return subprocess.run([MIEN, *arguments], capture_output=True, timeout=300, check=True)


def rows(text):
    return list(csv.DictReader(text.decode().splitlines()))


class Windows(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def succeeds(self, done):
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout

    def differ(self, ours, theirs):
        """The largest difference between two CSVs of the same frames, and its position; boxes are relative to the width of the face."""
        self.assertEqual([list(row) for row in ours], [list(row) for row in theirs])
        largest = (0.0, "")
        for a, b in zip(ours, theirs, strict=True):
            self.assertEqual((a["t_ms"], a["status"], a["lod"]), (b["t_ms"], b["status"], b["lod"]))
            for name in a.keys() - {"frame", "t_ms", "status", "lod"}:
                self.assertEqual(a[name] == "", b[name] == "", name)
                if a[name] != "":
                    scale = float(a["w"]) if name in "xywh" else 1.0
                    difference = abs(float(a[name]) - float(b[name])) / scale
                    self.assertTrue(math.isfinite(difference))
                    largest = max(largest, (difference, f"{name} of frame {a['frame']}"))
        return largest

    def test_version_and_inspect(self):
        self.assertEqual(self.succeeds(windows("--version")), here("--version").stdout)
        inspect = ("inspect", "--json", MODELS + "/basenet.mien")
        self.assertEqual(self.succeeds(windows(*inspect)), here(*inspect).stdout)

    def test_track_matches_this_machine(self):
        track = ("track", CLIP, "--quiet", "--models", MODELS, "--tier", "avx2", "--lod", "4")
        largest = self.differ(rows(self.succeeds(windows(*track))), rows(here(*track).stdout))
        print(f"demo.mp4, each with its own ffmpeg: largest difference {largest[0]:.2g} ({largest[1]})")
        self.assertLess(largest[0], OTHER_FFMPEG)

    def test_equal_images_give_equal_results(self):
        y4m, wav = str(self.folder / "clip.y4m"), str(self.folder / "clip.wav")
        subprocess.run(["ffmpeg", "-v", "error", "-i", CLIP, "-t", "2", "-pix_fmt", "yuv420p", y4m, "-t", "2", wav], check=True)
        track = ("track", "--audio", wav, "--quiet", "--models", MODELS, "--tier", "avx2", "--lod", "4")
        ours = rows(self.succeeds(windows(*track, y4m, path="/nowhere")))
        with open(y4m, "rb") as pictures:
            piped = self.succeeds(windows(*track, "-", path="/nowhere", stdin=pictures))
        self.assertEqual(rows(piped), ours, "bytes of standard input pass unchanged")
        largest = self.differ(ours, rows(here(*track, y4m).stdout))
        print(f"2 s as Y4M and WAV: largest difference {largest[0]:.2g} ({largest[1]})")
        self.assertLess(largest[0], SAME_PICTURES)

    def test_several_outputs(self):
        made = [str(self.folder / name) for name in ("a.csv", "a.glb", "a.jsonl", "a.llf.csv", "a.bvh")]
        more = {"--landmarks": "points.csv", "--overlay": "over.mp4"}
        options = [word for option, name in more.items() for word in (option, str(self.folder / name))]
        options += [word for name in made for word in ("-o", name)]
        (self.folder / "a.csv").write_text("previous content")
        self.succeeds(windows("track", CLIP, "--duration", "1", "--quiet", "--models", MODELS, *options))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         sorted(["a.csv", "a.glb", "a.jsonl", "a.llf.csv", "a.llf.csv.json", "a.bvh", *more.values()]))
        self.assertNotIn(b"\r", (self.folder / "a.csv").read_bytes())
        self.assertEqual(len(rows((self.folder / "a.csv").read_bytes())), 30)
        self.assertEqual(len((self.folder / "a.jsonl").read_text().splitlines()), 30)
        for path in self.folder.iterdir():
            self.assertGreater(path.stat().st_size, 30, path)
        # The program of this machine converts the curves to the same animation.
        converted = self.folder / "converted.bvh"
        here("convert", made[2], str(converted))
        self.assertEqual(converted.read_bytes(), (self.folder / "a.bvh").read_bytes())
        frames = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=codec_type,nb_read_frames",
                                 "-of", "csv=p=0", str(self.folder / "over.mp4")], capture_output=True, check=True).stdout
        self.assertIn(b"video,30", frames)
        self.assertIn(b"audio", frames)

    def test_report(self):
        page, curves, clip = (self.folder / name for name in ("page.html", "curves.csv", "clip.mp4"))
        self.succeeds(windows("track", CLIP, "--duration", "1", "--quiet", "--models", MODELS, "--report", str(page), "-o", str(curves)))
        report = report_page.Report(page)
        self.assertEqual((report.frames(), report.data["clip"]), (30, "in page"))
        self.assertEqual(report.export("csv"), curves.read_bytes())
        for kind in ("script", "style"):
            self.assertEqual(report.allowed(kind), [report_page.hash_of(report.page.blocks[kind])])
        clip.write_bytes(base64.b64decode(report.page.blocks["clip"], validate=True))
        frames = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=codec_name,nb_read_frames",
                                 "-of", "csv=p=0", str(clip)], capture_output=True, check=True).stdout
        self.assertIn(b"h264,30", frames)
        self.assertIn(b"aac", frames)

    def test_a_folder(self):
        (self.folder / "in/below").mkdir(parents=True)
        for name in ("a.mp4", "below/b b.MP4", "c.mp4"):
            shutil.copy(CLIP, self.folder / "in" / name)
        (self.folder / "in/broken.mp4").write_bytes(b"no video")
        track = ("track", "in", "--out", "out", "--duration", "0.5", "--jobs", "2", "--json", "--models", MODELS)
        done = windows(*track, cwd=self.folder)
        self.assertEqual(done.returncode, 12, done.stderr)
        self.assertEqual({row["file"]: row["outcome"] for row in json.loads(done.stdout)},
                         {"a.mp4": "done", "below/b b.MP4": "done", "broken.mp4": "failed", "c.mp4": "done"})
        self.assertEqual(len(rows((self.folder / "out/below/b b.MP4.csv").read_bytes())), 15)
        again = json.loads(windows(*track, cwd=self.folder).stdout)
        self.assertEqual([row["outcome"] for row in again], ["done before", "done before", "failed", "done before"])

    def test_any_name(self):
        made = self.folder / "made.mp4"
        subprocess.run(["ffmpeg", "-v", "error", "-i", CLIP, "-t", "0.2", str(made)], check=True)
        expected = None
        for name in NAMES:
            shutil.copy(made, self.folder / name)
            curves = name + ".csv"
            done = windows("track", "--quiet", "--models", MODELS, "--lod", "1", "-o" + curves, f"--overlay=over {name}", "--", name,
                           cwd=self.folder)
            self.assertEqual((done.returncode, done.stderr), (0, b""), name)
            text = (self.folder / curves).read_bytes()
            expected = expected or text
            self.assertEqual(text, expected, name)
            self.assertGreater((self.folder / f"over {name}").stat().st_size, 1000)
        done = windows("inspect", "not there Ünï 顔.mien", cwd=self.folder)
        self.assertIn("not there Ünï 顔.mien", done.stderr.decode())

    def test_live_sends(self):
        with Receiver() as receiver:
            send = f"jsonl://127.0.0.1:{receiver.port}"
            stats = str(self.folder / "stats.json")
            done = windows("live", "--camera", "test:" + CLIP, "--send", send, "--send", "-", "--stats", stats, "--quiet",
                           "--models", MODELS, "--lod", "1")
            self.assertEqual((done.returncode, done.stderr), (0, b""))
            packets = receiver.packets()
        statistics = json.loads(pathlib.Path(stats).read_text())
        self.assertEqual(statistics["frames"], len(packets))
        self.assertGreater(len(packets), 20)  # of 240; depends on the machine
        self.assertEqual([line.encode() for line in done.stdout.decode().split("\n")[:-1]], packets)
        tracked = [packet for packet in map(json.loads, packets) if packet["status"] == "tracking"]
        self.assertGreater(len(tracked), len(packets) / 2)
        self.assertGreater(max(packet["controls"]["jawOpen"] for packet in tracked), 0.2)

    def test_live_ends_without_a_reader(self):
        process = subprocess.Popen(["wine", EXE, "live", "--camera", "test:" + CLIP, "--send", "-", "--quiet", "--models", MODELS],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(FFMPEG))
        self.addCleanup(process.kill)
        self.assertIn("controls", json.loads(process.stdout.readline()))
        process.stdout.close()
        self.assertEqual((process.wait(120), process.stderr.read()), (0, b""))
        process.stderr.close()

    def test_errors_are_named(self):
        no_ffmpeg = windows("track", CLIP, "--models", MODELS, path="/nowhere")
        self.assertEqual((no_ffmpeg.returncode, no_ffmpeg.stderr.decode().splitlines()),
                         (6, ["mien: cannot run 'ffprobe': neither beside mien nor on PATH; install ffmpeg, for example with "
                              "`apt install ffmpeg`, `brew install ffmpeg` or `winget install ffmpeg`"]))
        (self.folder / "broken.mp4").write_bytes(b"no video")
        for arguments, code, words in [
                (("track", "missing.mp4"), 3, "missing.mp4: no such file"),
                (("track", "."), 3, "is a folder"),
                (("track", "broken.mp4"), 4, "broken.mp4: not a video: "),
                (("track", CLIP, "-o", "no/folder.csv"), 7, "no/folder.csv: cannot be written: No such file"),
                (("track", CLIP, "--overlay", "no/folder.mp4"), 7, "no/folder.mp4: cannot be written: "),
                (("inspect", "missing.mien"), 8, "missing.mien: cannot be opened"),
                (("live", "--camera", "test:" + CLIP, "--send", "vmc://no.such.host.invalid"), 7, "unknown host")]:
            done = windows(*arguments, cwd=self.folder, path=FFMPEG)
            self.assertEqual(done.returncode, code, (arguments, done.stderr))
            self.assertIn(words, done.stderr.decode())
        self.assertEqual([path.name for path in self.folder.iterdir()], ["broken.mp4"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
