"""Tests of the add-on's file readers and conversions against the program.

usage: files_test.py MIEN_PROGRAM
"""

import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest

import add_on  # noqa: F401
from mien_face.clip import ReadOptions, read_clip
from mien_face.conversion import values_in
from mien_face.frame import FaceDataError, Frame
from mien_face.rotation import of_angles
from mien_face.vocabularies import ARKIT, ROBLOX, VISEMES, VRM0

PROGRAM = sys.argv.pop(1)
ANGLES = ("pitch_rad", "yaw_rad", "roll_rad")
RANDOM = random.Random(1)


def random_rows(count, fps=29.97):
    """Smooth heads and eyes, as of people, so that units can be detected; other controls are random."""
    for i in range(count):
        controls = {name: max(0.0, round(RANDOM.uniform(-0.3, 1.0), 4)) for name in ARKIT}
        look = math.sin(i / 9)
        for side, towards in (("Left", 1), ("Right", -1)):
            controls["eyeLookOut" + side] = max(0.0, round(towards * look, 4))
            controls["eyeLookIn" + side] = max(0.0, round(-towards * look, 4))
        angles = [round(size * math.sin(i / 20 + size), 5) for size in (0.3, 0.7, 0.2)]
        yield round(1000.0 * i / fps, 3), dict(zip(ANGLES, angles)), controls


def write_csv(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["frame", "t_ms", "status", *ANGLES, *ARKIT])
        for number, (t_ms, angles, controls) in enumerate(rows):
            table.writerow([number, t_ms, "tracking", *angles.values(), *controls.values()])


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.rows = list(random_rows(150))
        self.source = self.path("source.csv")
        write_csv(self.source, self.rows)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return self.path(name)

    def convert(self, source, name, *options):
        done = subprocess.run([PROGRAM, "convert", source, self.path(name), *options], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.path(name)

    def read(self, path, **options):
        return read_clip(path, ReadOptions(**options))

    def assert_rejected(self, path, what, **options):
        with self.assertRaises(FaceDataError) as caught:
            self.read(path, **options)
        self.assertIn(what, str(caught.exception))
        self.assertTrue(str(caught.exception).startswith(os.path.basename(path) + ": "))

    def assert_same(self, frames, expected, tolerance):
        self.assertEqual(len(frames), len(expected))
        for frame, other in zip(frames, expected):
            self.assertAlmostEqual(frame.time_s - frames[0].time_s, other.time_s - expected[0].time_s, delta=1e-4)
            self.assertEqual(frame.values.keys(), other.values.keys())
            for vocabulary, values in frame.values.items():
                self.assertEqual(values.keys(), other.values[vocabulary].keys())
                for name, value in values.items():
                    self.assertAlmostEqual(value, other.values[vocabulary][name], delta=tolerance, msg=name)
            self.assertEqual(frame.head is None, other.head is None)
            if frame.head:
                self.assertAlmostEqual(sum(a * b for a, b in zip(frame.head, other.head)), 1.0, delta=1e-9)


class Conversion(WithFolder):
    def test_visemes_and_roblox_are_those_of_the_program(self):
        frames = self.read(self.source).frames
        for vocabulary, ending, names in (("visemes", ".visemes.csv", VISEMES), ("roblox", ".roblox.csv", ROBLOX)):
            expected = self.read(self.convert(self.source, "converted" + ending)).frames
            compared = 0
            for frame, other in zip(frames, expected, strict=True):
                for name, value in other.values[vocabulary].items():
                    self.assertAlmostEqual(values_in(vocabulary, frame)[name], value, delta=1e-6, msg=name)
                    compared += 1
            self.assertGreaterEqual(compared, len(frames) * (len(names) - 3))

    def test_means_need_all_controls_and_maxima_any(self):
        frame = Frame(0.0, {"arkit": {"eyeSquintLeft": 0.4, "mouthSmileLeft": 0.8, "jawOpen": 0.3}})
        self.assertEqual(values_in("roblox", frame)["LeftCheekRaiser"], 0.4)
        self.assertEqual(values_in("vrm0", frame), {"A": 0.3, "Fun": 0.0})
        self.assertNotIn("Joy", values_in("vrm0", frame))

    def test_nothing_follows_from_nothing(self):
        for vocabulary in ("arkit", "roblox", "visemes", "vrm0", "vrm1"):
            self.assertEqual(values_in(vocabulary, Frame(0.0)), {})
        self.assertEqual(values_in("vrm0", Frame(0.0, {"visemes": {"aa": 1.0}})), {})
        self.assertEqual(values_in("visemes", Frame(0.0, {"arkit": {"browInnerUp": 1.0}})), {})

    def test_a_mouth_at_rest_is_silence(self):
        still = values_in("visemes", Frame(0.0, {"arkit": dict.fromkeys(ARKIT, 0.0)}))
        self.assertEqual(still, {name: float(name == "sil") for name in VISEMES})
        self.assertEqual(len(VRM0), 11)


class MienCsv(WithFolder):
    def test_values_and_times_are_exact(self):
        clip = self.read(self.source)
        self.assertEqual(clip.start_s, 0.0)
        for frame, (t_ms, angles, controls) in zip(clip.frames, self.rows, strict=True):
            self.assertEqual(frame.time_s, t_ms / 1000.0)
            self.assertEqual(frame.values, {"arkit": controls})
            self.assertEqual(frame.head, of_angles(*angles.values()))

    def test_text_encodings_and_separators(self):
        with open(self.source) as file:
            text = file.read()
        for name, content in {
            "utf16.csv": text.encode("utf-16"),
            "utf16be.csv": text.encode("utf-16-be"),
            "mark.csv": text.encode("utf-8-sig"),
            "lines.csv": text.replace("\n", "\r\n"),
            "tabs.csv": text.replace(",", "\t"),
            "quotes.csv": text.replace("t_ms", '"t_ms"'),
            "semicolons.csv": text.replace(",", ";").replace(".", ","),
        }.items():
            with self.subTest(name):
                self.assertEqual(self.read(self.write(name, content)).frames, self.read(self.source).frames)

    def test_empty_cells_are_absent(self):
        path = self.write("gap.csv", "t_ms,pitch_rad,yaw_rad,roll_rad,jawOpen,mouthClose\n0,,,,,\n40,0,0.1,0,0.5,\n")
        first, second = self.read(path).frames
        self.assertEqual((first.values, first.head), ({"arkit": {}}, None))
        self.assertEqual(second.values, {"arkit": {"jawOpen": 0.5}})

    def test_one_of_several_faces(self):
        rows = "".join(f"{t},{face},{face / 10}\n" for t in range(5) for face in ((1, 2) if t < 2 else (2,)))
        path = self.write("two.csv", "t_ms,face_id,jawOpen\n" + rows)
        self.assertEqual([f.values["arkit"]["jawOpen"] for f in self.read(path).frames], [0.2] * 5)
        self.assertEqual(self.read(path).notes, ["face 2 of 2"])
        self.assertEqual(len(self.read(path, face_id=1).frames), 2)
        self.assert_rejected(path, "no row has face_id 3 (got 1, 2)", face_id=3)

    def test_faults_name_line_and_column(self):
        head = "t_ms,pitch_rad,yaw_rad,roll_rad,jawOpen\n"
        for content, what in {
            "": "line 1: empty file",
            "a,b\n1,2\n": "line 1: neither CSV of mien",
            "t_ms,x\n1,2\n": "line 1: no column with a control",
            head: "no frames",
            head + "0,0,0,0,x\n": "line 2: jawOpen: 'x' is not a number",
            head + "0,0,0,0,nan\n": "jawOpen: 'nan' is not a number",
            head + "0,0,0,0,1_0\n": "is not a number",
            head + "0,0,0,0,1.5\n": "line 2: jawOpen: '1.5' is not in 0..1",
            head + "0,7,0,0,1\n": "pitch_rad: more than a full turn",
            head + ",0,0,0,1\n": "line 2: t_ms: empty",
            head + "9,0,0,0,1\n8,0,0,0,1\n": "line 3: t_ms: decreasing time",
            head + "0,0,0\n": "line 2: wrong number of cells (got 3, expected 5)",
            head + '0,0,0,0,"1\n': "line 2: ",
            "t_ms,jawOpen,JAWOPEN\n0,1,1\n": "line 1: duplicate column 'JAWOPEN'",
            b"t_ms,jawOpen\n0,\xff\n": "byte 15: not UTF-8 text",
            "t_ms,face_id,jawOpen\n0,x,1\n": "face_id: 'x' is not a number of a face",
        }.items():
            with self.subTest(content):
                self.assert_rejected(self.write("bad.csv", content), what)
        self.assert_rejected(self.path("absent.csv"), "No such file")

    def test_damaged_files_are_read_or_rejected(self):
        with open(self.convert(self.source, "take.llf.csv"), "rb") as file:
            live_link = file.read()
        with open(self.source, "rb") as file:
            curves = file.read()
        rejected = 0
        for content in [curves, live_link] * 60:
            damaged = bytearray(content[: RANDOM.randrange(200, 6000)])
            for _ in range(RANDOM.randrange(4)):
                damaged[RANDOM.randrange(len(damaged))] = RANDOM.randrange(256)
            try:
                self.read(self.write("damaged.csv", bytes(damaged)))
            except FaceDataError:
                rejected += 1
        self.assertGreater(rejected, 40)


class LiveLinkCsv(WithFolder):
    def test_units_from_the_file_beside_it(self):
        for unit in ("rad", "norm180", "deg"):
            path = self.convert(self.source, f"{unit}.llf.csv", "--llf-rot", unit, "--llf-fps", "30")
            clip = self.read(path)
            self.assertEqual(clip.start_s, clip.frames[0].time_s)
            self.assert_same(clip.frames, self.read(self.source).frames, 1e-9)

    def test_detected_units_are_those_of_the_program(self):
        for unit in ("rad", "norm180", "deg"):
            for fps in ("24", "25", "30", "48", "50", "60", "97.5"):
                path = self.convert(self.source, "take.llf.csv", "--llf-rot", unit, "--llf-fps", fps)
                os.remove(path + ".json")
                program = subprocess.run(
                    [PROGRAM, "convert", path, self.path("back.csv")], capture_output=True, text=True
                )
                with self.subTest(unit=unit, fps=fps):
                    if program.returncode:
                        self.assert_rejected(path, "has more frames than a second")
                        continue
                    clip = self.read(path)
                    self.assert_same(clip.frames, self.read(self.path("back.csv")).frames, 1e-9)
                    if float(fps) <= 60:
                        self.assertEqual(clip.notes, [f"timecode {fps} fps, rotations in {unit}"])

    def test_options_override(self):
        path = self.convert(self.source, "take.llf.csv", "--llf-rot", "deg", "--llf-fps", "60")
        self.assert_rejected(path, "HeadYaw: more than half a turn in rad", llf_rotation="rad")
        self.assert_rejected(path, "has more frames than a second of 30", llf_fps=30.0)

    def test_rows_without_a_face_midnight_and_clamping(self):
        rows = ["23:59:59:59.000,61,0.5,2,0,0,0", "00:00:00:01.000,0", "00:00:00:02.000,61,0.25,-1,0,0,0"]
        path = self.write(
            "take.csv",
            "Timecode,BlendShapeCount,JawOpen,MouthClose,HeadYaw,HeadPitch,HeadRoll\n" + "\n".join(rows) + "\n",
        )
        clip = self.read(path)
        steps = [frame.time_s - clip.start_s for frame in clip.frames]
        for step, expected in zip(steps, (0, 2 / 60, 3 / 60)):
            self.assertAlmostEqual(step, expected, delta=1e-9)
        self.assertEqual(clip.frames[0].values["arkit"], {"jawOpen": 0.5, "mouthClose": 1.0})
        self.assertEqual((clip.frames[1].values, clip.frames[1].head), ({"arkit": {}}, None))
        self.assertEqual(clip.notes[1], "2 values outside 0..1 were clamped")

    def test_faults(self):
        head = "Timecode,BlendshapeCount,JawOpen,HeadYaw,HeadPitch,HeadRoll\n"
        for content, what in {
            "Timecode,JawOpen\n": "missing column BlendshapeCount",
            "Timecode,BlendshapeCount\n": "no column with a blend shape",
            head: "no frames",
            head + "1:2,1,0,0,0,0\n": "line 2: Timecode: '1:2' is not HH:MM:SS:FF.mmm",
            head + "0:0:60:0,1,0,0,0,0\n": "is not HH:MM:SS:FF.mmm",
            head + "0:0:0:99,1,0,0,0,0\n": "has more frames than a second of 60",
            head + "0:0:9:0,1,0,0,0,0\n0:0:8:0,1,0,0,0,0\n": "line 3: Timecode: decreasing time",
            head + "0:0:0:0,-1,0,0,0,0\n": "BlendshapeCount: '-1' is not a count",
            head + "0:0:0:0,1,0,0\n": "wrong number of cells",
            head + "0:0:0:0,1,x,0,0,0\n": "JawOpen: 'x' is not a number",
        }.items():
            with self.subTest(content):
                self.assert_rejected(self.write("bad.csv", content), what)

    def test_a_damaged_json_file_is_ignored(self):
        path = self.convert(self.source, "take.llf.csv")
        for content in ("{", "[1]", json.dumps({"rotation": [], "timecode_fps": "60"}), "[" * 100000):
            self.write("take.llf.csv.json", content)
            self.assert_same(self.read(path).frames, self.read(self.source).frames, 1e-9)


if __name__ == "__main__":
    unittest.main()
