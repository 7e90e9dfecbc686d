"""Common parts of the tests of `mien convert`: random frames, and a folder with a recording of all of them."""
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)
FRAMES = int(sys.argv.pop(1)) if len(sys.argv) > 1 else 10000
FPS = 60

ARKIT = """eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft eyeWideLeft eyeBlinkRight eyeLookDownRight
eyeLookInRight eyeLookOutRight eyeLookUpRight eyeSquintRight eyeWideRight jawForward jawLeft jawRight jawOpen mouthClose mouthFunnel
mouthPucker mouthLeft mouthRight mouthSmileLeft mouthSmileRight mouthFrownLeft mouthFrownRight mouthDimpleLeft mouthDimpleRight
mouthStretchLeft mouthStretchRight mouthRollLower mouthRollUpper mouthShrugLower mouthShrugUpper mouthPressLeft mouthPressRight
mouthLowerDownLeft mouthLowerDownRight mouthUpperUpLeft mouthUpperUpRight browDownLeft browDownRight browInnerUp browOuterUpLeft
browOuterUpRight cheekPuff cheekSquintLeft cheekSquintRight noseSneerLeft noseSneerRight tongueOut""".split()
# The header of a real recording.
LIVE_LINK = (
    "Timecode,BlendshapeCount,EyeBlinkLeft,EyeLookDownLeft,EyeLookInLeft,EyeLookOutLeft,EyeLookUpLeft,EyeSquintLeft,EyeWideLeft,"
    "EyeBlinkRight,EyeLookDownRight,EyeLookInRight,EyeLookOutRight,EyeLookUpRight,EyeSquintRight,EyeWideRight,JawForward,JawRight,JawLeft,"
    "JawOpen,MouthClose,MouthFunnel,MouthPucker,MouthRight,MouthLeft,MouthSmileLeft,MouthSmileRight,MouthFrownLeft,MouthFrownRight,"
    "MouthDimpleLeft,MouthDimpleRight,MouthStretchLeft,MouthStretchRight,MouthRollLower,MouthRollUpper,MouthShrugLower,MouthShrugUpper,"
    "MouthPressLeft,MouthPressRight,MouthLowerDownLeft,MouthLowerDownRight,MouthUpperUpLeft,MouthUpperUpRight,BrowDownLeft,BrowDownRight,"
    "BrowInnerUp,BrowOuterUpLeft,BrowOuterUpRight,CheekPuff,CheekSquintLeft,CheekSquintRight,NoseSneerLeft,NoseSneerRight,TongueOut,HeadYaw,"
    "HeadPitch,HeadRoll,LeftEyeYaw,LeftEyePitch,LeftEyeRoll,RightEyeYaw,RightEyePitch,RightEyeRoll").split(",")


def random_share(rng):
    return rng.choice((0.0, 1.0, 0.5, rng.random(), round(rng.random(), 6), rng.random() * 1e-5))


def random_frames(seed, count=FRAMES):
    rng = random.Random(seed)
    frames, t_ns = [], 0
    for number in range(count):
        frame = {"t_ns": t_ns, "frame": number, "status": rng.choice(("searching", "tracking", "tracking", "lost")),
                 "face_id": 0, "face_prob": random_share(rng), "lod": rng.randint(1, 4), "vad": random_share(rng),
                 "controls": {name: random_share(rng) for name in ARKIT}}
        if frame["status"] == "tracking":
            frame["box"] = [rng.uniform(-50, 900) for _ in range(4)]
            frame["head"] = {"pitch_rad": rng.uniform(-1.5, 1.5), "yaw_rad": rng.uniform(-3, 3),
                             "roll_rad": rng.uniform(-3, 3)}
            frame["position_m"] = [rng.uniform(-2, 2) for _ in range(3)]
            frame["eyes"] = {side: {"pitch_rad": rng.uniform(-0.6, 0.6), "yaw_rad": rng.uniform(-0.6, 0.6),
                                    "roll_rad": rng.uniform(-0.1, 0.1)}
                             for side in ("left", "right")}
        frames.append(frame)
        t_ns += rng.choice((16666667, 33333333, 1000, 40000000))
    return frames


def rotation_matrix(head):
    angles = [head[k] for k in ("pitch_rad", "yaw_rad", "roll_rad")]
    (sp, cp), (sy, cy), (sr, cr) = ((math.sin(angle), math.cos(angle)) for angle in angles)
    rx = [[1, 0, 0], [0, cp, -sp], [0, sp, cp]]
    ry = [[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]
    rz = [[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]]
    times = lambda a, b: [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return times(times(ry, rx), rz)


def matrix_of_quaternion(x, y, z, w):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


class ConvertTestCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.frames = random_frames(1)
        cls.source = cls.path("source.jsonl")
        cls.write("source.jsonl", "".join(json.dumps(frame) + "\n" for frame in cls.frames))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    @classmethod
    def write(cls, name, text):
        with open(cls.path(name), "w", newline="") as file:
            file.write(text)

    def read(self, name):
        with open(self.path(name), newline="") as file:
            return file.read()

    def convert(self, a, b, *more):
        done = subprocess.run([PROGRAM, "convert", self.path(a), self.path(b), *more], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def frames_of(self, name):
        return [json.loads(line) for line in self.read(name).splitlines()]

    # Reading and writing gives the same text.
    def assert_stable(self, name, *more):
        again = "again." + name
        self.convert(name, again, *more)
        self.assertEqual(self.read(again), self.read(name))

    def refused(self, a, b, *more):
        done = subprocess.run([PROGRAM, "convert", self.path(a), self.path(b), *more], capture_output=True, text=True)
        self.assertFalse(os.path.exists(self.path(b)), b)
        return done.returncode, done.stderr
