"""Tests of the add-on's parts without Blender: names, packets, sockets, rotations, curves."""

import json
import math
import random
import re
import socket
import struct
import subprocess
import sys
import time
import unittest

import add_on
from mien_face.conversion import VOCABULARIES
from mien_face.curves import control_curves, head_curve
from mien_face.frame import FaceDataError, Frame
from mien_face.packets import decode
from mien_face.receiver import Receiver
from mien_face.recording import MAX_FRAMES, Recording
from mien_face.rotation import AXES, inverse, nearer, of_angles, of_bone, product, scaled, to_space
from mien_face.shape_names import TABLES, match, plain
from mien_face.vocabularies import ARKIT, READY_PLAYER_ME, ROBLOX, VISEMES, VRM0, VRM1


def live_link(values, subject="Face", version=6, rate=(60, 1), frame=(120, 0.5)):
    text = subject.encode()
    return (
        struct.pack(">BI36sI", version, 36, b"0" * 36, len(text))
        + text
        + struct.pack(">IfII", *frame, *rate)
        + struct.pack(f">B{len(values)}f", len(values), *values)
    )


def json_packet(**more):
    return json.dumps({"t_ns": 1_500_000_000, "controls": {"jawOpen": 0.25}, **more}).encode()


class Vocabularies(unittest.TestCase):
    def test_the_table_is_that_of_the_sources(self):
        done = subprocess.run(
            [sys.executable, add_on.ROOT + "/apps/blender/generate_vocabularies.py", "--check"],
            capture_output=True,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_vocabulary_has_a_table_of_names(self):
        self.assertEqual(tuple(TABLES), VOCABULARIES)
        for vocabulary, names in (
            ("arkit", ARKIT),
            ("roblox", ROBLOX),
            ("visemes", VISEMES),
            ("vrm0", VRM0),
            ("vrm1", VRM1),
        ):
            self.assertEqual(set(TABLES[vocabulary].values()), set(names))


class ShapeNames(unittest.TestCase):
    def assert_all(self, names, keys, vocabulary, **options):
        self.assertEqual(match(tuple(keys), **options), {key: (vocabulary, name) for name, key in zip(names, keys)})

    def test_every_spelling_of_arkit(self):
        for spelled in (
            str,
            str.upper,
            str.capitalize,
            lambda n: re.sub("(Left|Right)$", lambda m: "_" + m[0][0], n),
            lambda n: re.sub("(Left|Right)$", lambda m: "." + m[0][0], n),
            lambda n: re.sub("([A-Z])", r"_\1", n).lower(),
            lambda n: n + ".001",
            lambda n: "blendShape1." + n,
            lambda n: "Head_" + n + "_geo",
            lambda n: "CC_" + re.sub("(Left|Right)$", lambda m: m[0][0], n),
        ):
            keys = [spelled(name) for name in ARKIT]
            with self.subTest(keys[0]):
                self.assert_all(ARKIT, keys, "arkit")

    def test_other_vocabularies(self):
        self.assert_all(ROBLOX, ROBLOX, "roblox")
        self.assert_all(VISEMES, READY_PLAYER_ME, "visemes")
        self.assert_all(VISEMES, ["vrc.v_" + name.lower() for name in VISEMES], "visemes")
        self.assert_all(VRM0, VRM0, "vrm0")
        self.assert_all(VRM1, VRM1, "vrm1")

    def test_vroid(self):
        keys = (
            "Fcl_ALL_Neutral",
            "Fcl_ALL_Joy",
            "Fcl_BRW_Joy",
            "Fcl_EYE_Close",
            "Fcl_EYE_Close_L",
            "Fcl_MTH_A",
            "Fcl_MTH_Up",
        )
        self.assertEqual(
            match(keys),
            {"Fcl_ALL_Joy": ("vrm0", "Joy"), "Fcl_EYE_Close_L": ("vrm0", "Blink_L"), "Fcl_MTH_A": ("vrm0", "A")},
        )

    def test_arkit_wins_over_visemes_on_the_same_mesh(self):
        keys = (*READY_PLAYER_ME, *ARKIT, "mouthOpen")
        self.assertEqual(match(keys), {name: ("arkit", name) for name in ARKIT})

    def test_visemes_leave_the_rest_of_the_face_to_arkit(self):
        found = match((*VISEMES, "eyeBlinkLeft", "browInnerUp", "jawOpen", "mouthClose"))
        self.assertEqual(found["eyeBlinkLeft"], ("arkit", "eyeBlinkLeft"))
        self.assertEqual(found["aa"], ("visemes", "aa"))
        self.assertFalse({"jawOpen", "mouthClose"} & found.keys())

    def test_given_vocabulary_and_affixes(self):
        keys = ("A", "x_jawOpen_y", "jawOpen")
        self.assertEqual(match(keys, "vrm0"), {"A": ("vrm0", "A")})
        self.assertEqual(match(keys, prefix="x_", suffix="_y"), {"x_jawOpen_y": ("arkit", "jawOpen")})

    def test_unknown_names_move_nothing(self):
        self.assertEqual(match(("Key 1", "Fat", "Muscular", "Basis")), {})
        self.assertEqual(match(()), {})
        self.assertEqual(match(("", "___", "Ünïcode", "x" * 5000)), {})

    def test_plain(self):
        for name, expected in {
            "mouthSmile_L": "mouthsmileleft",
            "eyeBlinkR": "eyeblinkright",
            "Jaw-Open": "jawopen",
            "Fur": "fur",
        }.items():
            self.assertEqual(plain(name), expected)


class Packets(unittest.TestCase):
    def test_json(self):
        frame = decode(
            json_packet(head={"pitch_rad": 0.1, "yaw_rad": 0.2, "roll_rad": 0.3, "q": []}, visemes={"aa": 1}, later=[1])
        )
        self.assertEqual(
            frame, Frame(1.5, {"arkit": {"jawOpen": 0.25}, "visemes": {"aa": 1.0}}, of_angles(0.1, 0.2, 0.3))
        )

    def test_live_link_face(self):
        values = [i / 64 for i in range(52)] + [0.5, -0.25, 0.125] + [0.0] * 6
        frame = decode(live_link(values, subject="Größe"))
        self.assertEqual(frame, Frame(120.5 / 60, {"arkit": dict(zip(ARKIT, values))}, of_angles(0.25, 0.5, 0.125)))
        degrees = values[:52] + [math.degrees(v) for v in values[52:]]
        head = decode(live_link(degrees), "deg").head
        self.assertAlmostEqual(sum(a * b for a, b in zip(head, frame.head)), 1.0, delta=1e-9)

    def test_live_link_face_without_a_face(self):
        blank = live_link([])
        for packet in (blank, blank[:-1]):
            self.assertEqual(decode(packet), Frame(120.5 / 60, {"arkit": {}}))

    def test_malformed_packets_are_described(self):
        nan, one = float("nan"), live_link([0.5])
        for data, what in {
            b"": "unknown packet",
            b"hello": "unknown packet",
            b"{": "JSON: ",
            b"{}": "t_ns: missing",
            b'{"t_ns":true}': "t_ns",
            b'{"t_ns":1e3}': "t_ns",
            b'{"t_ns":%d}' % 10**20: "t_ns",
            b'{"t_ns":1,"controls":[]}': "controls: expected an object",
            json_packet(controls={"jawOpen": 2}): "jawOpen: expected a number in 0..1",
            json_packet(controls={"jawOpen": True}): "jawOpen",
            json_packet(controls={"jawOpen": nan}): "NaN is not a number",
            json_packet(head={"pitch_rad": 1}): "yaw_rad",
            b'{"t_ns":' + b"[" * 60000: "JSON",
            b"\xff{": "unknown packet",
            b'{"\xff': "JSON",
            b'{"t_ns":1,"controls":{"a":1e999}}': "a: ",
            live_link([], version=5): "unknown version (got 5, expected 6)",
            one[:-1]: "truncated",
            b"\6": "truncated",
            b"\6\xff\xff\xff\xff": "truncated",
            live_link([nan]): "not a finite number",
            live_link([], rate=(0, 1)): "frame rate is 0",
        }.items():
            with self.subTest(data[:40]), self.assertRaises(FaceDataError) as caught:
                decode(data)
            self.assertIn(what, str(caught.exception))

    def test_damaged_packets_never_raise_anything_else(self):
        dice = random.Random(2)
        for _ in range(3000):
            damaged = bytearray(dice.choice((json_packet(head={"yaw_rad": 0.1}), live_link([0.5] * 61))))
            for _ in range(dice.randrange(1, 6)):
                damaged[dice.randrange(len(damaged))] = dice.randrange(256)
            try:
                decode(bytes(damaged[: dice.randrange(len(damaged) + 1)]))
            except FaceDataError:
                pass


class Sockets(unittest.TestCase):
    def setUp(self):
        self.receiver = Receiver(0)
        self.addCleanup(self.receiver.close)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.sender.close)
        self.sender.connect(("127.0.0.1", self.receiver.port))

    def poll(self, count):
        """Until `count` frames and errors have arrived, or for a second."""
        frames, end = [], time.monotonic() + 1.0
        while self.receiver.frames + self.receiver.errors < count and time.monotonic() < end:
            frames += self.receiver.poll()
        return frames

    def test_frames_and_errors(self):
        for data in (json_packet(), b"?", live_link([0.5] * 61)):
            self.sender.send(data)
        self.assertEqual([f.time_s for f in self.poll(3)], [1.5, 120.5 / 60])
        self.assertEqual((self.receiver.frames, self.receiver.errors), (2, 1))
        self.assertIn("unknown packet (1 bytes)", self.receiver.last_error)
        self.assertEqual(self.receiver.poll(), [])

    def test_a_flood_is_read_in_parts(self):
        for _ in range(300):
            self.sender.send(b"?")
        self.receiver.poll()
        self.assertLessEqual(self.receiver.errors, 256)

    def test_the_port_is_free_after_close_and_not_before(self):
        with self.assertRaises(FaceDataError) as caught:
            Receiver(self.receiver.port)
        self.assertIn(f"port: cannot listen on 127.0.0.1:{self.receiver.port}", str(caught.exception))
        self.receiver.close()
        Receiver(self.receiver.port).close()

    def test_invalid_ports(self):
        with self.assertRaises(FaceDataError):
            Receiver(70000)


class Recordings(unittest.TestCase):
    def recorded(self, times):
        recording = Recording(10.0)
        for sent_s, arrival_s in times:
            recording.add(Frame(sent_s, {"arkit": {"jawOpen": 0.5}}, (1.0, 0.0, 0.0, 0.0)), arrival_s)
        return recording

    def test_steps_are_the_senders(self):
        frames = self.recorded([(100.0, 10.5), (100.1, 10.7), (100.2, 10.71), (100.3, 19.0), (101.3, 19.0)]).frames()
        for frame, expected in zip(frames, (0.5, 0.6, 0.7, 0.8, 1.8), strict=True):
            self.assertAlmostEqual(frame.time_s, expected, delta=1e-9)
        self.assertEqual(frames[0].values, {"arkit": {"jawOpen": 0.5}})

    def test_a_new_sender_continues(self):
        times = [f.time_s for f in self.recorded([(100.0, 10.0), (3.0, 10.1), (3.1, 10.2), (90000.0, 10.3)]).frames()]
        for actual, expected in zip(times, (0.0, 0.1, 0.2, 0.3), strict=True):
            self.assertAlmostEqual(actual, expected, delta=1e-9)

    def test_other_vocabularies_are_kept(self):
        recording = Recording(0.0)
        values = {"arkit": {"jawOpen": 0.1}, "visemes": {"aa": 0.2}}
        recording.add(Frame(0.0, values), 0.0)
        self.assertEqual(recording.frames(), [Frame(0.0, values)])

    def test_memory_is_limited(self):
        recording = Recording(0.0)
        recording._rows = [None] * MAX_FRAMES
        recording.add(Frame(0.0), 0.0)
        self.assertTrue(recording.full)
        self.assertEqual(len(recording), MAX_FRAMES)


def turned(q, v):
    return product(product(q, (0.0, *v)), inverse(q))[1:]


class Rotations(unittest.TestCase):
    # Left, up and front of a character that faces each direction.
    SPACES = {
        "-Y": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
        "Y": ((-1, 0, 0), (0, 0, 1), (0, 1, 0)),
        "X": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
        "-X": ((0, -1, 0), (0, 0, 1), (-1, 0, 0)),
        "Z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    }

    def assert_close(self, a, b):
        for x, y in zip(a, b, strict=True):
            self.assertAlmostEqual(x, y, delta=1e-12)

    def test_the_head_turns_the_same_way_in_every_space(self):
        self.assertEqual(self.SPACES.keys(), AXES.keys())
        c, s = math.cos(0.4), math.sin(0.4)
        for front_name, (left, up, front) in self.SPACES.items():
            mix = lambda a, x, b, y: tuple(p * x + r * y for p, r in zip(a, b))
            with self.subTest(front_name):
                self.assert_close(
                    turned(to_space(of_angles(0.4, 0, 0), front_name), front), mix(front, c, up, -s)
                )  # looks down
                self.assert_close(
                    turned(to_space(of_angles(0, 0.4, 0), front_name), front), mix(front, c, left, s)
                )  # to its left
                self.assert_close(
                    turned(to_space(of_angles(0, 0, 0.4), front_name), up), mix(up, c, left, -s)
                )  # leans to its right

    def test_a_bone_rotates_about_the_axes_of_the_armature(self):
        rest, q = of_angles(0.3, -1.2, 2.0), of_angles(0.2, 0.5, -0.1)
        basis = of_bone(q, rest)
        self.assert_close(turned(product(rest, basis), (1, 2, 3)), turned(q, turned(rest, (1, 2, 3))))

    def test_scaled(self):
        self.assert_close(scaled(of_angles(0, 0.2, 0), 2.0), of_angles(0, 0.4, 0))
        self.assert_close(scaled(tuple(-p for p in of_angles(0, 0.2, 0)), 0.5), of_angles(0, 0.1, 0))
        self.assert_close(scaled(of_angles(0, 0.2, 0), 0.0), of_angles(0, 0, 0))
        self.assert_close(scaled(of_angles(0, 0, 0), 3.0), of_angles(0, 0, 0))

    def test_nearer(self):
        q = of_angles(0.1, 0.2, 0.3)
        self.assertEqual(nearer(tuple(-p for p in q), q), q)


class Curves(unittest.TestCase):
    def test_gaps_hold_and_coinciding_keys_are_one(self):
        rows = [(0.0, 0.1), (1.0, None), (2.0, None), (3.0, 0.3), (3.0 + 1e-9, 0.4), (4.0, 0.5)]
        frames = [
            Frame(t, {"arkit": {} if v is None else {"jawOpen": v}}, None if v is None else of_angles(v, 0, 0))
            for t, v in rows
        ]
        curves = control_curves(
            frames, lambda t: 1000 + t, {("arkit", "jawOpen"), ("arkit", "tongueOut"), ("vrm0", "A")}
        )
        self.assertEqual(curves.keys(), {("arkit", "jawOpen"), ("vrm0", "A")})
        curve = curves["arkit", "jawOpen"]
        self.assertEqual(curve, curves["vrm0", "A"])
        self.assertEqual(
            (curve.times, curve.values, curve.holds), ([1000.0, 1003.0, 1004.0], [0.1, 0.3, 0.5], [True, False, False])
        )
        self.assertEqual(head_curve(frames, lambda t: t).holds, [True, False, False])

    def test_the_heads_quaternions_do_not_jump(self):
        frames = [Frame(i, {}, of_angles(0, i * 0.5 - 3.0, 0)) for i in range(14)] + [
            Frame(14, {}, of_angles(0, -2.4, 0))
        ]
        curve = head_curve(frames, float)
        for a, b in zip(curve.values, curve.values[1:]):
            self.assertGreater(sum(x * y for x, y in zip(a, b)), 0.9)


if __name__ == "__main__":
    unittest.main()
