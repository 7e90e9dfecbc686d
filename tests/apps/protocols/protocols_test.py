"""Tests of every protocol with 10 000 random frames and independent decoders.

usage: protocols_test.py PROTOCOL_PACKETS
"""
import json
import math
import os
import random
import struct
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import avatar_values
import live_packets as decode
from live_packets import ARKIT

TOOL = sys.argv.pop(1)
FRAMES = int(sys.argv.pop(1))


def random_frame(random, i):
    frame = {"t_ns": i * 33_333_333 + random.randrange(1_000_000), "status": random.choice(("tracking", "lost")),
             "face_id": random.randrange(1, 1 << 31), "face_prob": random.random(), "box": [random.uniform(-100, 600) for _ in range(4)],
             "controls": {name: random.choice((0.0, 1.0, random.random())) for name in ARKIT if random.random() < 0.9}}
    if random.random() < 0.9:
        frame["head"] = {"pitch_rad": random.uniform(-1.5, 1.5), "yaw_rad": random.uniform(-3, 3), "roll_rad": random.uniform(-3, 3)}
        frame["position_m"] = [random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, -0.2)]
    if random.random() < 0.5:
        frame["eyes"] = {side: {"pitch_rad": random.uniform(-1, 1), "yaw_rad": random.uniform(-1, 1), "roll_rad": 0.0} for side in ("left", "right")}
    return frame


def packets_of(protocol, frames):
    lines = "".join(json.dumps(frame) + "\n" for frame in frames)
    data = subprocess.run([TOOL, protocol], input=lines.encode(), stdout=subprocess.PIPE, check=True).stdout
    at = 0
    for _ in frames:
        count, = struct.unpack_from("<I", data, at)
        at += 4
        packets = []
        for _ in range(count):
            size, = struct.unpack_from("<I", data, at)
            packets.append(data[at + 4:at + 4 + size])
            at += 4 + size
        yield packets
    assert at == len(data)


def turn(a, b, angle):
    """In the plane of axes a and b, from the first to the second"""
    m = [[float(i == j) for j in range(3)] for i in range(3)]
    m[a][a] = m[b][b] = math.cos(angle)
    m[a][b], m[b][a] = -math.sin(angle), math.sin(angle)
    return m


def times(*matrices):
    product = matrices[0]
    for m in matrices[1:]:
        product = [[sum(row[k] * m[k][j] for k in range(3)) for j in range(3)] for row in product]
    return product


def matrix(head):
    return times(turn(2, 0, head["yaw_rad"]), turn(1, 2, head["pitch_rad"]), turn(0, 1, head["roll_rad"]))


def of_quaternion(x, y, z, w):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


STRAIGHT = {"pitch_rad": 0.0, "yaw_rad": 0.0, "roll_rad": 0.0}
FULL_LOOK = 0.485  # rad, of a gaze control at 1


def eyes_of(frame):
    if "eyes" in frame:
        return frame["eyes"]["left"], frame["eyes"]["right"]
    c = lambda name: frame["controls"].get(name, 0.0)
    look = lambda side, out, back: {"pitch_rad": FULL_LOOK * (c("eyeLookDown" + side) - c("eyeLookUp" + side)),
                                    "yaw_rad": FULL_LOOK * (c(out) - c(back)), "roll_rad": 0.0}
    return look("Left", "eyeLookOutLeft", "eyeLookInLeft"), look("Right", "eyeLookInRight", "eyeLookOutRight")


def openseeface_features(control):
    share = lambda value: min(max(value, -1), 1)
    eyes, brows, corners, widths = [], [], [], []
    for side in "Left", "Right":
        of = lambda name, side=side: control(name + side)
        inner = control("browInnerUp")
        eyes.append(of("eyeWide") - of("eyeBlink"))
        brows += [share(of("browDown") - inner), share((inner + of("browOuterUp")) / 2 - of("browDown")), share(of("browOuterUp") - inner)]
        widths.append(share(max(of("mouthSmile"), of("mouthStretch")) - control("mouthPucker")))
        corners += [share(of("mouthSmile") - of("mouthFrown")), widths[-1]]
    return [*eyes, *brows, *corners, max(0, control("jawOpen") - control("mouthClose")), sum(widths) / 2]


class Protocols(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rng = random.Random(18)
        cls.frames = [random_frame(rng, i) for i in range(FRAMES)]

    def near(self, got, wanted, tolerance=1e-6):
        self.assertEqual(len(got), len(wanted))
        for a, b in zip(got, wanted):
            if abs(a - b) > tolerance * max(1.0, abs(b)):
                self.fail(f"{got} is not {wanted}")

    def test_bytes_written_by_hand(self):
        frame = {"t_ns": 1_000_000_000, "status": "tracking", "face_id": 3, "face_prob": 1, "controls": {"eyeBlinkLeft": 1.0}, "box": [0, 0, 0, 0],
                 "head": {"pitch_rad": 0.0, "yaw_rad": 0.5, "roll_rad": 0.0}, "position_m": [0.0, 0.0, -0.5]}
        one = lambda protocol: next(iter(packets_of(protocol, [frame])))
        self.assertTrue(one("vmc")[0].startswith(
            b"#bundle\0" b"\0\0\0\0\0\0\0\1"
            b"\0\0\0\x24" b"/VMC/Ext/OK\0" b",iiii\0\0\0" b"\0\0\0\1" b"\0\0\0\3" b"\0\0\0\0" b"\0\0\0\1"
            b"\0\0\0\x14" b"/VMC/Ext/T\0\0" b",f\0\0" b"\x3f\x80\0\0"
            b"\0\0\0\x44" b"/VMC/Ext/Bone/Pos\0\0\0" b",sfffffff\0\0\0" b"Head\0\0\0\0" + bytes(12) + bytes(4) + b"\xbe\x7d\x57\x77" b"\x80\0\0\0" b"\x3f\x78\x0a\xa5"
            b"\0\0\0\x2c" b"/VMC/Ext/Blend/Val\0\0" b",sf\0" b"eyeBlinkLeft\0\0\0\0" b"\x3f\x80\0\0"))
        self.assertTrue(one("vmc")[-1].endswith(b"\0\0\0\x1c" b"/VMC/Ext/Blend/Apply\0\0\0\0" b",\0\0\0"))
        self.assertEqual(one("llf"), [b"\6" b"\0\0\0\x24" + b"A" * 36 + b"\0\0\0\7M\xc3\xbcller" b"\0\0\0\x3c" b"\0\0\0\0" b"\0\0\0\x3c" b"\0\0\0\1" b"\x3d"
                                      b"\x3f\x80\0\0" + bytes(51 * 4) + b"\x3f\0\0\0" + bytes(8 * 4)])
        self.assertEqual(len(one("llf")[0]), 312 + 1)  # the name with 6 letters takes 7 bytes
        self.assertTrue(one("ifm")[0].startswith(b"eyeBlink_L-100|eyeLookDown_L-0|"))
        self.assertTrue(one("ifm2")[0].startswith(b"eyeBlink_L&100|eyeLookDown_L&0|"))
        self.assertIn(b"|tongueOut-0|=head#0.0000,-28.6479,0.0000,0.000000,0.000000,-0.500000|rightEye#0.0000,", one("ifm")[0])
        self.assertTrue(one("ifm")[0].endswith(b"|leftEye#0.0000,0.0000,0.0000|"))
        self.assertEqual(one("opentrack"), [bytes(16) + b"\0\0\0\0\0\0\x49\xc0" + struct.pack("<d", math.degrees(0.5)) + bytes(16)])
        osf = one("osf")[0]
        self.assertEqual(osf[:33], b"\0\0\0\0\0\0\xf0\x3f" b"\3\0\0\0" b"\0\0\x20\x44" b"\0\0\xf0\x43" b"\0\0\x80\x3f" b"\0\0\0\0" b"\1" b"\0\0\0\0")
        self.assertEqual(osf[73:345], b"\0\0\x80\x3f" * 68)
        self.assertEqual(osf[345:889], bytes(544))
        self.assertEqual(osf[1729:1733], b"\0\0\x80\xbf")  # the left eye is closed

    def test_vmc(self):
        for frame, packets in zip(self.frames, packets_of("vmc", self.frames)):
            got = decode.vmc(packets)
            self.assertEqual(got["ok"], [1, 3, 0, int(frame["status"] == "tracking")])
            self.near([got["t"]], [frame["t_ns"] * 1e-9])
            self.assertEqual(list(got["blends"]), ARKIT)
            self.near(list(got["blends"].values()), [frame["controls"].get(name, 0.0) for name in ARKIT])
            self.assertEqual(got["head"] is None, "head" not in frame)
            if "head" in frame:  # the same rotation in a space with opposite x
                self.assertEqual(got["head"][:3], [0, 0, 0])
                turned = of_quaternion(*got["head"][3:])
                wanted = matrix(frame["head"])
                self.near([turned[i][j] * (-1 if (i == 0) != (j == 0) else 1) for i in range(3) for j in range(3)], sum(wanted, []), 1e-5)

    def test_live_link(self):
        nothing = {"t_ns": 0, "status": "searching", "controls": {"jawOpen": 0.0}}
        frames = self.frames + [dict(nothing, t_ns=10**15)]
        for frame, (packet,) in zip(frames, packets_of("llf", frames)):
            got = decode.live_link(packet)
            self.assertEqual((got["device"], got["subject"]), ("A" * 36, "Müller"))
            self.assertLess(abs(got["time_s"] - frame["t_ns"] * 1e-9), 1e-4)
            if frame["status"] == "searching":
                self.assertEqual(got["values"], ())
                continue
            turns = [frame.get("head", STRAIGHT), *eyes_of(frame)]
            self.near(got["values"], [frame["controls"].get(name, 0.0) for name in ARKIT] +
                      [value for t in turns for value in (t["yaw_rad"], -t["pitch_rad"], t["roll_rad"])])
        self.assertEqual(len(packet), 1 + 4 + 36 + 4 + 7 + 16 + 1)

    def test_ifacialmocap(self):
        for protocol, separator in (("ifm", "-"), ("ifm2", "&")):
            for frame, (packet,) in zip(self.frames, packets_of(protocol, self.frames)):
                self.assertLessEqual(len(packet), 1472)  # one datagram of Ethernet
                got = decode.ifacialmocap(packet, separator)
                self.assertEqual(list(got["values"]), decode.IFACIALMOCAP)
                for name, value in zip(ARKIT, got["values"].values()):
                    self.assertLessEqual(abs(value - 100 * frame["controls"].get(name, 0.0)), 0.5 + 1e-9)
                degrees = lambda t: [math.degrees(t["pitch_rad"]), -math.degrees(t["yaw_rad"]), math.degrees(t["roll_rad"])]
                self.near(got["head"], degrees(frame.get("head", STRAIGHT)) + frame.get("position_m", [0, 0, 0]), 1e-4)
                left, right = eyes_of(frame)
                self.near(got["leftEye"], degrees(left), 1e-4)
                self.near(got["rightEye"], degrees(right), 1e-4)

    def same_values(self, got, wanted, tolerance=1e-6):
        self.assertEqual(sorted(got), sorted(wanted))
        self.near([got[name] for name in sorted(got)], [wanted[name] for name in sorted(got)], tolerance)

    def test_vrchat(self):
        for frame, packets in zip(self.frames, packets_of("vrchat", self.frames)):
            got, tracking = decode.vrchat(packets), frame["status"] == "tracking"
            self.assertEqual(got["active"], [tracking] * 3)
            self.same_values(got["parameters"], avatar_values.vrchat(frame))
            wanted = avatar_values.native_eyes(frame) if tracking else {}
            self.assertEqual(list(got["native"]), list(wanted))
            for name, values in wanted.items():
                self.near(got["native"][name], values)
        self.assertIn(b"/avatar/parameters/FT/v2/JawOpen\0", packets[-1] + packets[-2])
        nothing, = packets_of("vrchat", [{"t_ns": 0, "status": "searching", "controls": {}}])
        self.assertEqual(decode.vrchat(nothing), {"active": [False] * 3, "parameters": {}, "native": {}})

    def test_vts(self):
        for frame, (packet,) in zip(self.frames, packets_of("vts", self.frames)):
            request = json.loads(packet)
            self.assertEqual((request["apiName"], request["apiVersion"], request["messageType"]),
                             ("VTubeStudioPublicAPI", "1.0", "InjectParameterDataRequest"))
            data = request["data"]
            self.assertEqual((data["faceFound"], data["mode"]), (frame["status"] == "tracking", "set"))
            got = {value["id"]: value["value"] for value in data["parameterValues"]}
            self.assertEqual(len(got), len(data["parameterValues"]))
            self.same_values(got, avatar_values.vts(frame), 1e-12)
        self.assertEqual(len(avatar_values.CUSTOM), 50)
        self.assertTrue(all(name.isalnum() and 4 <= len(name) <= 32 for name in got))
        nothing, = packets_of("vts", [{"t_ns": 0, "status": "searching", "controls": {}}])
        self.assertEqual(nothing, [b""])

    def test_opentrack(self):
        for frame, (packet,) in zip(self.frames, packets_of("opentrack", self.frames)):
            head = frame.get("head", STRAIGHT)
            self.near(list(decode.opentrack(packet).values()), [100 * x for x in frame.get("position_m", [0, 0, 0])] +
                      [math.degrees(head[key]) for key in ("yaw_rad", "pitch_rad", "roll_rad")], 1e-12)

    def test_openseeface(self):
        dropped = {48, 54}  # of iBUG's 68 points
        for number, (frame, (packet,)) in enumerate(zip(self.frames, packets_of("osf", self.frames))):
            got = decode.openseeface(packet)
            control = lambda name: frame["controls"].get(name, 0.0)
            self.assertEqual((got["time"], got["id"], got["size"], got["success"]),
                             (frame["t_ns"] * 1e-9, frame["face_id"], (640, 480), int("head" in frame)))
            self.near(got["open"], [1 - control("eyeBlinkRight"), 1 - control("eyeBlinkLeft")])
            self.near(got["confidence"], [frame["face_prob"]] * 68)
            x, y, w, h = frame["box"]
            landmarks = [(x + i / 67 * w, y + (1 - i / 67) * h) for i in range(68) if i not in dropped] + [(x, y), (x + w, y)]
            for a, b in zip(got["landmarks"], landmarks):
                self.near(a, b, 1e-5)
            features = got["features"]
            self.assertTrue(all(-1 <= f <= 1 for f in features))
            self.near(features, openseeface_features(control))
            if "head" in frame and number % 20 == 0:  # because it is slow
                self.check_openseeface_space(frame, got)

    # Checks against receivers, and against the guarantee of OpenSeeFace's solver: a proper rotation whose projection is that of the head.
    def check_openseeface_space(self, frame, got):
        head, (x, y, z, w) = matrix(frame["head"]), got["quaternion"]
        raw = of_quaternion(-x, -y, -z, w)  # theirs is that of the transposed matrix
        up, left = [-head[1][0], head[1][1], head[1][2]], [head[0][0], -head[0][1], -head[0][2]]  # axes right, up, out
        self.near(raw[0] + raw[1], up + left, 1e-5)
        a, b, c = [math.radians(e) for e in got["euler"]]
        self.near(sum(times(turn(0, 1, c), turn(2, 0, b), turn(1, 2, a)), []), sum(raw, []), 1e-4)
        # Projecting the 3D points gives the landmarks.
        unit, focal = 0.14, 500
        tx, ty, tz = got["translation"]
        nose = [-ty * unit, tx * unit, tz * unit]
        for i, (px, py, pz) in enumerate(got["points"][:68]):
            point = [-px * unit, -py * unit, -pz * unit]
            seen = [nose[k] + sum(head[k][j] * point[j] for j in range(3)) for k in range(3)]
            if abs(seen[2]) > 0.05:
                u, v = got["landmarks"][i]
                tolerance = 0.05 * max(1, (abs(seen[0]) + abs(seen[1])) / abs(seen[2]))
                self.assertLess(abs(320 - focal * seen[0] / seen[2] - u), tolerance)
                self.assertLess(abs(240 + focal * seen[1] / seen[2] - v), tolerance)

    def test_openseeface_straight_ahead(self):
        frame = {"t_ns": 0, "controls": {}, "head": STRAIGHT, "position_m": [0.1, 0.2, -0.7], "box": [320, 240, 0, 0]}
        (packet,), = packets_of("osf", [frame])
        got = decode.openseeface(packet)
        x, y, z = got["euler"]
        self.near([(z - 90) % 360, (x + 180) % 360 % 360, y], [0, 0, 0], 1e-4)  # as OpenSee.cs in Unity reads them
        tx, ty, tz = got["translation"]
        self.near([tz * 0.14], [-0.7 + 0.118], 1e-6)  # the tip of the nose in front of the centre of the head

    # All landmarks are in the centre of the image, so that the remaining offset of a point is its depth.
    def test_openseeface_depths_are_those_of_a_face(self):
        frame = {"t_ns": 0, "controls": {}, "head": STRAIGHT, "position_m": [0, 0, -0.7], "box": [320, 240, 0, 0]}
        (packet,), = packets_of("osf", [frame])
        depths = [-z * 0.14 for _, _, z in decode.openseeface(packet)["points"]]  # before the tip of the nose, metres
        contours = {"jaw": range(17), "right brow": range(17, 22), "left brow": range(22, 27), "nose": range(27, 31),
                    "nostrils": range(31, 36), "right eye": range(36, 42), "left eye": range(42, 48), "lips": range(48, 58),
                    "inside": range(58, 66)}
        for name, contour in contours.items():
            for a, b in zip(contour, contour[1:]):
                self.assertLess(abs(depths[a] - depths[b]), 0.0185, (name, a))
        self.assertTrue(all(-0.11 < depth <= 1e-9 for depth in depths[:68]))
        self.assertEqual(depths[27:31], sorted(depths[27:31]))
        mirrored = [(i, 16 - i) for i in range(8)] + [(17 + i, 26 - i) for i in range(5)] + [(31, 35), (32, 34)]
        mirrored += [(36, 45), (37, 44), (38, 43), (39, 42), (40, 47), (41, 46), (48, 52), (49, 51), (53, 57), (54, 56)]
        mirrored += [(58, 62), (59, 61), (63, 65), (66, 67)]
        for a, b in mirrored:
            self.assertAlmostEqual(depths[a], depths[b], 6, (a, b))
        lip, chin, pupil, corners = depths[50], depths[8], depths[66], depths[36:42:3]
        self.assertTrue(chin < lip and pupil > min(corners) and pupil < depths[38] + 0.01)
        for eyeball in depths[68:70]:  # behind the middle of the corners
            self.assertAlmostEqual(eyeball, sum(corners) / 2 - 0.385 * abs(corners[0] - corners[1]), 6)


if __name__ == "__main__":
    unittest.main()
