"""Tests of mien convert with independent readers and writers, based on the descriptions of the formats.

usage: convert_test.py MIEN_PROGRAM [FRAMES]
Converts FRAMES random frames (default 10 000) to every format and back; all must keep the precision of the format.
"""
import csv
import json
import math
import os
import random
import re
import subprocess
import unittest
import xml.etree.ElementTree

import conversions
from conversions import ARKIT, FPS, FRAMES, PROGRAM, ConvertTestCase

FACS = """ChinRaiserUpperLip ChinRaiser FlatPucker Funneler LowerLipSuck LipPresser LipsTogether MouthLeft MouthRight Pucker UpperLipSuck
LeftCheekPuff LeftDimpler LeftLipCornerDown LeftLowerLipDepressor LeftLipCornerPuller LeftLipStretcher LeftUpperLipRaiser RightCheekPuff
RightDimpler RightLipCornerDown RightLowerLipDepressor RightLipCornerPuller RightLipStretcher RightUpperLipRaiser JawDrop JawLeft JawRight
Corrugator LeftBrowLowerer LeftOuterBrowRaiser LeftNoseWrinkler LeftInnerBrowRaiser RightBrowLowerer RightOuterBrowRaiser
RightInnerBrowRaiser RightNoseWrinkler EyesLookDown EyesLookLeft EyesLookUp EyesLookRight LeftCheekRaiser LeftEyeUpperLidRaiser
LeftEyeClosed RightCheekRaiser RightEyeUpperLidRaiser RightEyeClosed TongueDown TongueOut TongueUp""".split()
# ARKit controls of each unit: a single one, the mean, the maximum or the minimum.
ONE_TO_ONE = """LeftEyeClosed=eyeBlinkLeft RightEyeClosed=eyeBlinkRight LeftEyeUpperLidRaiser=eyeWideLeft RightEyeUpperLidRaiser=eyeWideRight
JawDrop=jawOpen JawLeft=jawLeft JawRight=jawRight LipsTogether=mouthClose Funneler=mouthFunnel Pucker=mouthPucker MouthLeft=mouthLeft
MouthRight=mouthRight LeftLipCornerPuller=mouthSmileLeft RightLipCornerPuller=mouthSmileRight LeftLipCornerDown=mouthFrownLeft
RightLipCornerDown=mouthFrownRight LeftDimpler=mouthDimpleLeft RightDimpler=mouthDimpleRight LeftLipStretcher=mouthStretchLeft
RightLipStretcher=mouthStretchRight LowerLipSuck=mouthRollLower UpperLipSuck=mouthRollUpper ChinRaiser=mouthShrugLower
ChinRaiserUpperLip=mouthShrugUpper LeftLowerLipDepressor=mouthLowerDownLeft RightLowerLipDepressor=mouthLowerDownRight
LeftUpperLipRaiser=mouthUpperUpLeft RightUpperLipRaiser=mouthUpperUpRight LeftBrowLowerer=browDownLeft RightBrowLowerer=browDownRight
LeftInnerBrowRaiser=browInnerUp RightInnerBrowRaiser=browInnerUp LeftOuterBrowRaiser=browOuterUpLeft RightOuterBrowRaiser=browOuterUpRight
LeftCheekPuff=cheekPuff RightCheekPuff=cheekPuff LeftNoseWrinkler=noseSneerLeft RightNoseWrinkler=noseSneerRight TongueOut=tongueOut"""
FACS_OF = {unit: (max, [name]) for unit, name in (pair.split("=") for pair in ONE_TO_ONE.split())}
mean = lambda values: sum(values) / len(values)
FACS_OF |= {
    "LeftCheekRaiser": (max, ["eyeSquintLeft", "cheekSquintLeft"]),
    "RightCheekRaiser": (max, ["eyeSquintRight", "cheekSquintRight"]),
    "EyesLookUp": (mean, ["eyeLookUpLeft", "eyeLookUpRight"]),
    "EyesLookDown": (mean, ["eyeLookDownLeft", "eyeLookDownRight"]),
    "EyesLookLeft": (mean, ["eyeLookOutLeft", "eyeLookInRight"]),
    "EyesLookRight": (mean, ["eyeLookInLeft", "eyeLookOutRight"]),
    "LipPresser": (mean, ["mouthPressLeft", "mouthPressRight"]), "Corrugator": (min, ["browDownLeft", "browDownRight"]),
}
VISEMES = "sil PP FF TH DD kk CH SS nn RR aa E ih oh ou".split()


def seconds_of_timecode(text, fps=FPS):
    found = re.fullmatch(r"(\d\d):(\d\d):(\d\d):(\d\d\.\d\d\d)", text)
    hours, minutes, seconds, frames = found.groups()
    return 3600 * int(hours) + 60 * int(minutes) + int(seconds) + float(frames) / fps


class Convert(ConvertTestCase):
    def test_json_lines_store_everything(self):
        self.assertNotIn("omitted", self.convert("source.jsonl", "all.jsonl"))
        for before, after in zip(self.frames, self.frames_of("all.jsonl"), strict=True):
            if "head" in after:
                q = after["head"].pop("q")
                for row, wanted in zip(conversions.matrix_of_quaternion(*q),
                                       conversions.rotation_matrix(before["head"])):
                    for a, b in zip(row, wanted):
                        self.assertAlmostEqual(a, b, places=12)
            self.assertEqual(before, after)
        self.assert_stable("all.jsonl")

    def test_csv(self):
        message = self.convert("source.jsonl", "curves.csv")
        self.assertIn("omitted: eye rotation", message)
        rows = list(csv.DictReader(self.read("curves.csv").splitlines()))
        for frame, row in zip(self.frames, rows, strict=True):
            self.assertEqual(round(float(row["t_ms"]) * 1e6), frame["t_ns"])
            self.assertEqual((row["status"], int(row["frame"]), int(row["lod"])), (frame["status"], frame["frame"],
                                                                                   frame["lod"]))
            self.assertEqual((float(row["face_prob"]), float(row["vad"])), (frame["face_prob"], frame["vad"]))
            self.assertEqual({name: float(row[name]) for name in ARKIT}, frame["controls"])
            if frame["status"] == "tracking":
                self.assertEqual([float(row[k]) for k in "xywh"], frame["box"])
                self.assertEqual([float(row[k]) for k in ("tx_m", "ty_m", "tz_m")], frame["position_m"])
                self.assertEqual({k: float(row[k]) for k in ("pitch_rad", "yaw_rad", "roll_rad")}, frame["head"])
            else:
                self.assertEqual({row[k] for k in ("x", "w", "pitch_rad", "tz_m")}, {""})
        self.assert_stable("curves.csv")

    def test_live_link_face(self):
        units = {"rad": 1.0, "norm180": 1 / math.pi, "deg": 180 / math.pi}
        for unit, scale in units.items():
            name = f"{unit}.llf.csv"
            self.convert("source.jsonl", name, "--llf-rot", unit)
            self.assertEqual(json.loads(self.read(name + ".json")), {"rotation": unit, "timecode_fps": 60.0})
            lines = self.read(name).splitlines()
            self.assertEqual(lines[0].split(","), conversions.LIVE_LINK)
            for frame, line in zip(self.frames, lines[1:], strict=True):
                cells = line.split(",")
                self.assertEqual((len(cells), cells[1]), (63, "61"))
                row = dict(zip(conversions.LIVE_LINK, cells))
                day = 24 * 3600
                self.assertLess(abs((seconds_of_timecode(row["Timecode"]) - frame["t_ns"] * 1e-9 + day / 2) % day - day
                                    / 2), 0.6e-3 / FPS)
                for control in ARKIT:
                    self.assertEqual(row[control[0].upper() + control[1:]], f"{frame['controls'][control]:.10f}",
                                     control)
                angles = {"Head": frame.get("head", {"pitch_rad": 0, "yaw_rad": 0, "roll_rad": 0})}
                if "eyes" in frame:
                    angles |= {"LeftEye": frame["eyes"]["left"], "RightEye": frame["eyes"]["right"]}
                for joint, wanted in angles.items():
                    for axis, sign in (("Yaw", 1), ("Pitch", -1), ("Roll", 1)):
                        self.assertAlmostEqual(float(row[joint + axis]), sign * scale * wanted[axis.lower() + "_rad"],
                                               delta=1e-10 * 0.51 + 1e-13)
            self.assert_stable(name, "--llf-rot", unit)  # the JSON file beside it has the unit
        os.remove(self.path("deg.llf.csv.json"))
        self.convert("deg.llf.csv", "told.llf.csv", "--from-llf-rot", "deg", "--llf-rot", "deg")
        self.assertEqual(self.read("told.llf.csv"), self.read("deg.llf.csv"))

    def test_live_link_face_of_other_programs(self):
        older = ("timecode,blendShapeCount,eyeBlinkRight,jawRight,jawLeft\r\n"
                 "14:03:52:28.207,61,0.25,0.5,0.75\r\n14:03:52:29.207,0\r\n14:03:53:00.000,61,0,0,1.25\r\n")
        self.write("older.csv", older)
        self.assertIn("1 values clamped to 0..1", self.convert("older.csv", "older.jsonl"))
        first, none, last = self.frames_of("older.jsonl")
        self.assertEqual(first["controls"], {"eyeBlinkRight": 0.25, "jawRight": 0.5, "jawLeft": 0.75})
        self.assertAlmostEqual(first["t_ns"] * 1e-9, 14 * 3600 + 3 * 60 + 52 + 28.207 / 60, places=8)
        self.assertEqual((none["status"], none["controls"]), ("searching", {}))
        self.assertEqual(last["controls"]["jawLeft"], 1)
        self.write("midnight.csv", "Timecode,BlendshapeCount,JawOpen\n23:59:59:59.000,61,0\n00:00:00:01.000,61,1\n")
        self.convert("midnight.csv", "midnight.jsonl")
        before, after = self.frames_of("midnight.jsonl")
        self.assertAlmostEqual((after["t_ns"] - before["t_ns"]) * 1e-9, 2 / 60, places=8)

    def test_bvh(self):
        self.convert("source.jsonl", "head.bvh", "--fps", "30")
        self.convert("source.jsonl", "even.jsonl", "--fps", "30")
        wanted = self.frames_of("even.jsonl")
        lines = self.read("head.bvh").splitlines()
        self.assertEqual(lines[0], "HIERARCHY")
        channels = next(line for line in lines if "CHANNELS" in line).split()[2:]
        motion = lines.index("MOTION")
        self.assertEqual(lines[motion + 1], f"Frames: {len(wanted)}")
        self.assertAlmostEqual(float(lines[motion + 2].removeprefix("Frame Time: ")), 1 / 30, places=7)
        turn, place = {"pitch_rad": 0, "yaw_rad": 0, "roll_rad": 0}, [0, 0, 0]
        for frame, line in zip(wanted, lines[motion + 3:], strict=True):
            turn = {k: v for k, v in frame.get("head", turn).items() if k != "q"}
            place = frame.get("position_m", place)
            values = dict(zip(channels, line.split(), strict=True))
            for axis, metres in zip("XYZ", place):
                self.assertAlmostEqual(float(values[axis + "position"]), metres, delta=0.51e-6)
            for axis, key in (("Y", "yaw_rad"), ("X", "pitch_rad"), ("Z", "roll_rad")):
                self.assertAlmostEqual(float(values[axis + "rotation"]), math.degrees(turn[key]), delta=0.51e-6)
        # the order of R = Ry Rx Rz
        self.assertEqual([c for c in channels if "rotation" in c], ["Yrotation", "Xrotation", "Zrotation"])
        self.assert_stable("head.bvh")

    def test_bvh_with_a_whole_body(self):
        self.write("body.bvh", """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Neck
  {
    OFFSET 0 1 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT Head
    {
      OFFSET 0 0.5 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0 0.1 0
      }
    }
  }
}
MOTION
Frames: 1
Frame Time: 0.04
1 2 3 0 0 90 90 0 0 0 0 -90
""")
        self.convert("body.bvh", "body.jsonl")
        frame, = self.frames_of("body.jsonl")
        # Hips rotate z to x, the neck x to y (roll), the head back about its own y: R = Ry(90) Rz(90) Ry(-90).
        wanted = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
        for row, expected in zip(conversions.rotation_matrix(frame["head"]), wanted):
            for a, b in zip(row, expected):
                self.assertAlmostEqual(a, b, places=9)
        # The head is half a unit along the neck's rotated y, which is -x of the hips and z of the world.
        for a, b in zip(frame["position_m"], [1, 3, 3.5]):
            self.assertAlmostEqual(a, b, places=9)

    def test_roblox(self):
        self.convert("source.jsonl", "units.roblox.csv")
        rows = list(csv.DictReader(self.read("units.roblox.csv").splitlines()))
        self.assertEqual(list(rows[0])[-50:], FACS)
        for frame, row in zip(self.frames, rows, strict=True):
            for unit in FACS:
                if unit in FACS_OF:
                    join, names = FACS_OF[unit]
                    self.assertEqual(float(row[unit]), join([frame["controls"][name] for name in names]), unit)
                else:
                    self.assertEqual(row[unit], "", unit)
        self.assert_stable("units.roblox.csv")
        # Values derived from controls round-trip through controls.
        self.convert("units.roblox.csv", "units.csv")
        self.convert("units.csv", "twice.roblox.csv")
        for a, b in zip(rows, csv.DictReader(self.read("twice.roblox.csv").splitlines()), strict=True):
            self.assertEqual({k: v for k, v in a.items() if k != "Corrugator"}, {k: v for k, v in b.items()
                                                                                 if k != "Corrugator"})
        self.convert("source.jsonl", "small.roblox.csv", "--roblox-lod", "1")
        small = list(csv.DictReader(self.read("small.roblox.csv").splitlines()))
        self.assertEqual(list(small[0])[-6:], ["JawDrop", "RightEyeClosed", "LeftEyeClosed", "RightLipCornerPuller",
                                               "LeftLipCornerPuller", "Pucker"])
        self.assertEqual([row["JawDrop"] for row in small], [row["JawDrop"] for row in rows])

    def test_roblox_units_are_kept(self):
        rng = random.Random(2)
        rows = [[str(i), str(i * 40)] + [repr(conversions.random_share(rng)) for _ in FACS] for i in range(FRAMES)]
        self.write("own.roblox.csv", "\n".join(",".join(row) for row in [["frame", "t_ms"] + FACS] + rows) + "\n")
        self.convert("own.roblox.csv", "own.jsonl")
        for row, frame in zip(rows, self.frames_of("own.jsonl"), strict=True):
            self.assertEqual(frame["facs"], dict(zip(FACS, map(float, row[2:]))))
        self.convert("own.jsonl", "own.again.roblox.csv")
        for row, again in zip(rows, csv.DictReader(self.read("own.again.roblox.csv").splitlines()), strict=True):
            self.assertEqual([float(again[unit]) for unit in FACS], [float(cell) for cell in row[2:]])

    def test_visemes(self):
        self.convert("source.jsonl", "mouth.visemes.csv")
        rows = list(csv.DictReader(self.read("mouth.visemes.csv").splitlines()))
        self.assertEqual(list(rows[0])[-15:], VISEMES)
        for row in rows:
            self.assertAlmostEqual(sum(float(row[v]) for v in VISEMES), 1, places=9)
            self.assertGreaterEqual(min(float(row[v]) for v in VISEMES), 0)
        self.assert_stable("mouth.visemes.csv")
        # Random mixtures of visemes are converted to controls and back.
        rng = random.Random(3)
        mixtures = []
        for _ in range(FRAMES):
            weights = [rng.random() * rng.choice((0, 1)) for _ in VISEMES]
            total = sum(weights) or 1
            mixtures.append([w / total for w in weights] if any(weights) else [1] + 14 * [0])
        self.write("mix.visemes.csv", ",".join(["t_ms"] + VISEMES) + "\n" + "".join(
            f"{i * 33}," + ",".join(map(repr, mixture)) + "\n" for i, mixture in enumerate(mixtures)))
        self.convert("mix.visemes.csv", "mix.csv")
        self.convert("mix.csv", "back.visemes.csv")
        for mixture, row in zip(mixtures, csv.DictReader(self.read("back.visemes.csv").splitlines()), strict=True):
            for wanted, viseme in zip(mixture, VISEMES):
                self.assertAlmostEqual(float(row[viseme]), wanted, places=6)

    def test_rhubarb(self):
        rng = random.Random(4)
        hundredths, cues, last = 0, [], None
        while len(cues) < FRAMES:
            shape = rng.choice([s for s in "ABCDEFGHX" if s != last])
            cues.append((hundredths, shape))
            hundredths, last = hundredths + rng.randint(1, 40), shape
        seconds = lambda h: f"{h // 100}.{h % 100:02d}"
        self.write("cues.tsv", "".join(f"{seconds(h)}\t{s}\n" for h, s in cues) + f"{seconds(hundredths)}\tX\n")
        self.assert_stable("cues.tsv")
        self.convert("cues.tsv", "cues.rhubarb.json")
        read = json.loads(self.read("cues.rhubarb.json"))
        ends = [h for h, _ in cues[1:]] + [hundredths]
        self.assertEqual([(cue["start"], cue["end"], cue["value"]) for cue in read["mouthCues"]],
                         [(float(seconds(h)), float(seconds(e)), s) for (h, s), e in zip(cues, ends)])
        self.assertEqual(read["metadata"]["duration"], float(seconds(hundredths)))
        self.assert_stable("cues.rhubarb.json")
        self.convert("cues.rhubarb.json", "back.tsv")
        self.assertEqual(self.read("back.tsv"), self.read("cues.tsv"))
        self.convert("cues.tsv", "cues.xml")
        root = xml.etree.ElementTree.fromstring(self.read("cues.xml"))
        self.assertEqual(root.tag, "rhubarbResult")
        self.assertEqual([(cue.get("start"), cue.get("end"), cue.text) for cue in root.find("mouthCues")],
                         [(seconds(h), seconds(e), s) for (h, s), e in zip(cues, ends)])
        self.assertEqual(root.find("metadata/duration").text, seconds(hundredths))
        self.assert_stable("cues.xml")
        self.convert("cues.xml", "back.tsv")
        self.assertEqual(self.read("back.tsv"), self.read("cues.tsv"))
        # The first cue within a frame of 1/24 s counts.
        self.convert("cues.tsv", "cues.dat")
        switches, last = ["MohoSwitch1"], 0
        for h, shape in cues:
            if h * 24 // 100 + 1 != last:
                last = h * 24 // 100 + 1
                switches.append(f"{last} {shape}")
        switches.append(f"{max(hundredths * 24 // 100 + 1, last + 1)} X")
        self.assertEqual(self.read("cues.dat").splitlines(), switches)
        self.convert("cues.dat", "again.dat")  # consecutive equal shapes are merged
        merged = [row for i, row in enumerate(switches)
                  if i < 2 or i == len(switches) - 1 or row.split()[1] != switches[i - 1].split()[1]]
        self.assertEqual(self.read("again.dat").splitlines(), merged)
        self.assert_stable("again.dat")
        self.write("blair.dat", "MohoSwitch1\r\n1 E\r\n25 AI\r\n49 E\r\n73 rest\r\n")
        self.convert("blair.dat", "blair.tsv")
        self.assertEqual(self.read("blair.tsv"), "0.00\tC\n1.00\tD\n2.00\tC\n3.00\tX\n")

    def test_names_in_xml(self):
        cue = '<mouthCue start="0" end="1">D</mouthCue>'
        self.write("a.xml",
                   '<?xml version="1.0"?>\n<!-- made by hand --><rhubarbResult><metadata><soundFile>a &amp; &lt;b&gt; '
                   '&quot;</soundFile>'
                   f"</metadata><mouthCues>{cue}<other/></mouthCues></rhubarbResult>\n")
        self.convert("a.xml", "a.rhubarb.json")
        self.assertEqual(json.loads(self.read("a.rhubarb.json"))["metadata"]["soundFile"], 'a & <b> "')

    def test_invalid_xml_and_switch_data(self):
        head = "<rhubarbResult>\n <mouthCues>\n  "
        tail = "\n </mouthCues>\n</rhubarbResult>\n"
        for text, place, word in (
                (head + '<mouthCue start="1" end="x">D</mouthCue>' + tail, (3, 3), "end: expected a time in seconds"),
                (head + '<mouthCue start="2" end="1">D</mouthCue>' + tail, (3, 3), "decreasing time"),
                (head + '<mouthCue start="0" end="1">Q</mouthCue>' + tail, (3, 3),
                 "unknown mouth shape, expected A to H or X (got 'Q')"),
                (head + tail, (1, 1), "no cues"), ("<html></html>", (1, 1), "expected rhubarbResult"),
                (head + "<mouthCue></rhubarbResult>", (3, 13), "unexpected closing tag"), (head, (3, 3),
                                                                                           "<mouthCues> is not closed"),
                (head + '<mouthCue start="0" start="1"/>' + tail, (3, 29), "duplicate attribute 'start'"),
                (head + "<mouthCue start=0/>" + tail, (3, 19), "expected a quotation mark"), (head + "&nbsp;", (3, 3),
                                                                                              "unknown entity"),
                ("<rhubarbResult/>x", (1, 17), "text outside"), ("<!-- no end", (1, 1), "expected -->"), ("<", (1, 2),
                                                                                                          "a tag name"),
                ("MohoSwitch1\n0 X\n", (2, 1), "'0' is not a frame"), ("MohoSwitch1\n1 X\n1 D\n", (3, 1),
                                                                       "decreasing time"),
                ("MohoSwitch1\n1 nothing\n", (2, 3), "unknown mouth shape"), ("MohoSwitch1\n1 X\n", (3, 1), "no cues")):
            self.write("bad.txt", text)
            done = subprocess.run([PROGRAM, "convert", self.path("bad.txt"), self.path("never.csv"), "--quiet"],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 3, text)
            self.assertIn(f"bad.txt: line {place[0]}, column {place[1]}: ", done.stderr, text)
            self.assertIn(word, done.stderr)
            self.assertFalse(os.path.exists(self.path("never.csv")))

    def test_shapes_and_poses(self):
        # Shapes are converted to controls and back; those that last long enough are kept.
        self.write("slow.tsv",
                   "0.00\tX\n0.50\tD\n1.00\tA\n1.50\tF\n2.00\tG\n2.50\tE\n3.00\tC\n3.50\tB\n4.00\tH\n4.50\tX\n5.00\tX\n")
        self.convert("slow.tsv", "slow.csv", "--fps", "100")
        self.convert("slow.csv", "slow.back.tsv")
        self.assertEqual(self.read("slow.back.tsv"), self.read("slow.tsv").replace("5.00\tX", "5.01\tX"))

    def test_another_rate(self):
        self.convert("source.jsonl", "even.jsonl", "--fps", "24")
        even = self.frames_of("even.jsonl")
        self.assertEqual([frame["t_ns"] for frame in even], [round(k * 1e9 / 24) for k in range(len(even))])
        after = 0
        for frame in even:
            while self.frames[after]["t_ns"] <= frame["t_ns"] and after + 1 < len(self.frames):
                after += 1
            a, b = self.frames[after - 1], self.frames[after]
            share = (frame["t_ns"] - a["t_ns"]) / (b["t_ns"] - a["t_ns"])
            self.assertEqual(frame["status"], a["status"])
            for name in ("jawOpen", "eyeBlinkLeft"):
                wanted = a["controls"][name] + share * (b["controls"][name] - a["controls"][name])
                self.assertAlmostEqual(frame["controls"][name], wanted, places=12)

    def test_the_report_is_json_for_any_file_name(self):
        with open(self.path("plain.csv"), "w") as file:
            file.write("t_ms,jawOpen\n0,0\n40,0.5\n")
        names = [os.fsencode(self.path(name)) + b"-\xff.csv" for name in ("in", "out")]
        os.rename(self.path("plain.csv"), names[0])
        done = subprocess.run([PROGRAM, "convert", *names, "--json"], capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        message = json.loads(done.stderr.decode())
        self.assertEqual((message["frames"], message["input"]), (2, self.path("in") + "-\ufffd.csv"))
        self.assertTrue(os.path.exists(names[1]))

    def test_several_faces(self):
        frames = [{"t_ns": 40000000 * i, "frame": i, "face_id": face, "controls": {"jawOpen": face / 4}}
                  for i in range(20) for face in (1, 2)
                  if face == 1 or i >= 5]
        self.write("two.jsonl", "".join(json.dumps(frame) + "\n" for frame in frames))
        self.assertNotIn("omitted", self.convert("two.jsonl", "two.csv"))
        rows = list(csv.DictReader(self.read("two.csv").splitlines()))
        self.assertEqual([(int(r["frame"]), int(r["face_id"]), float(r["jawOpen"])) for r in rows],
                         [(f["frame"], f["face_id"], f["controls"]["jawOpen"]) for f in frames])
        self.assertIn("all faces but 1", self.convert("two.jsonl", "two.llf.csv"))
        self.assertNotIn("all faces", self.convert("two.jsonl", "second.llf.csv", "--face", "2"))
        self.assertEqual({row["JawOpen"]
                          for row in csv.DictReader(self.read("second.llf.csv").splitlines())}, {"0.5000000000"})

    def test_units_of_live_link_face_are_noted(self):
        rows = ["Timecode,BlendshapeCount,JawOpen,HeadYaw,HeadPitch,HeadRoll"]
        rows += [f"10:00:{i // 25:02}:{i % 25:02}.000,61,0,20.0,-8.5,3.0" for i in range(75)]
        self.write("phone.csv", "\n".join(rows) + "\n")
        message = self.convert("phone.csv", "phone.jsonl")
        self.assertIn("timecode: 25 frames per second, detected (--from-llf-fps)", message)
        self.assertIn("rotations: degrees, detected (--from-llf-rot)", message)
        frames = self.frames_of("phone.jsonl")
        self.assertEqual([frame["t_ns"] - frames[0]["t_ns"] for frame in frames], [40000000 * i for i in range(75)])
        self.assertEqual(self.convert("phone.csv", "phone.jsonl", "--quiet"), "")
        told = json.loads(self.convert("phone.csv", "phone.jsonl", "--json"))
        self.assertEqual(len(told["notes"]), 2)
        code, message = self.refused("phone.csv", "phone.out.jsonl", "--from-llf-rot", "rad")
        self.assertEqual(code, 3)
        self.assertIn("HeadYaw: more than half a turn in radians (got 20, expected -3.14 to 3.14; --from-llf-rot", message)

    def test_units_of_bvh_are_options(self):
        self.write("one.jsonl", json.dumps({"t_ns": 0, "position_m": [0.5, 0.25, -1],
                                            "head": {"pitch_rad": 0, "yaw_rad": 0, "roll_rad": 0}}) + "\n")
        self.assertNotIn("positions", self.convert("one.jsonl", "cm.bvh", "--bvh-unit", "cm"))
        self.assertIn("\n50.000000 25.000000 -100.000000 ", self.read("cm.bvh"))
        self.assertIn("positions: centimetres, detected from the size of the skeleton (--from-bvh-unit)",
                      self.convert("cm.bvh", "cm.jsonl"))
        self.assertEqual(self.frames_of("cm.jsonl")[0]["position_m"], [0.5, 0.25, -1])
        self.assertNotIn("positions", self.convert("cm.bvh", "m.jsonl", "--from-bvh-unit", "m"))
        self.assertEqual(self.frames_of("m.jsonl")[0]["position_m"], [50, 25, -100])

    def test_unknown_endings_are_rejected(self):
        self.write("one.csv", "t_ms,jawOpen\n0,0\n")
        for name in ("x.fbx", "x.txt", "x.csv.gz", "x.json", "x.v2"):
            code, message = self.refused("one.csv", name)
            self.assertEqual(code, 2)
            self.assertIn(
                f"{name}: unknown format (got {os.path.splitext(name)[1]}, expected one of .csv, .jsonl, .llf.csv, "
                ".gltf, .glb", message)
            self.assertIn("--to csv, jsonl, llf", message)
        self.convert("one.csv", "x.fbx", "--to", "csv")
        self.assertEqual(self.read("x.fbx").splitlines()[1].split(",")[:2], ["0", "0"])
        self.convert("one.csv", "no_ending")
        self.assertTrue(self.read("no_ending").startswith("frame,t_ms,"))

    def test_errors_have_a_position(self):
        faults = {
            "t_ms,jawOpen\n0,0\n40,lots\n": "line 3, column 4: jawOpen: 'lots' is not a number",
            "Timecode,BlendshapeCount,JawOpen\n00:00:00:00.000,61,0\nnever,61,0\n": "line 3, column 1: Timecode: "
                                                                                    "'never' is not HH:MM:SS:FF.mmm",
            "Timecode,BlendshapeCount,JawOpen\n00:00:00:61.000,61,0\n": "line 2, column 1: Timecode: '00:00:00:61.000' "
                                                                        "has more frames than a second of 60 "
                                                                        "(--from-llf-fps)",
            '{"t_ns":0,"controls":{}}\n{"t_ns":1,"controls":{"jawOpen":"x"}}\n': "line 2, column 33: jawOpen: expected "
                                                                                 "a number in 0..1",
            '{"t_ns":0}\n{"t_ns":1,}\n': "line 2, column 11: expected a key in quotation marks",
            "HIERARCHY\nROOT a\n{\nOFFSET 0 0 zero\n": "line 4, column 12: 'zero' is not a number",
            "t_ms,JawDrop,Pucker\n0,0,0\n40,0,-1\n": "line 3, column 6: Pucker: '-1' is not in 0..1",
            "t_ms,sil,PP\n0,1,0\n40,,much\n": "line 3, column 5: PP: 'much' is not a number",
            "0.00\tX\n0.10\tQ\n0.20\tX\n": "line 2, column 6: unknown mouth shape, expected A to H or X",
            "0.00\tX\n0.10\n": "line 2, column 5: unknown mouth shape, expected A to H or X",
            '{"mouthCues":[\n{"start":0,"end":1,"value":"X"},\n{"start":1,"end":"2","value":"D"}]}':
                "line 3, column 18: end: expected a time in seconds",
            '{"asset":{},\n"animations":[]}': "line 1, column 1: no animation",
            "glTF\1\0\0\0" + 12 * "\0": "byte 4: expected glTF version 2",
        }
        for text, wanted in faults.items():
            self.write("bad", text)
            done = subprocess.run([PROGRAM, "convert", self.path("bad"), self.path("bad.out.csv")], capture_output=True,
                                  text=True)
            self.assertEqual((done.returncode, done.stderr), (3, f"mien: {self.path('bad')}: {wanted}\n"))
            self.assertFalse(os.path.exists(self.path("bad.out.csv")))


if __name__ == "__main__":
    unittest.main()
