"""Tests of the work and memory of mien convert: twice the input takes at most 2.3 times the instructions, and memory is at most 8 times the
input plus 64 MB. Typical and worst-case files of every format.

usage: convert_size_test.py MIEN_PROGRAM [count | time]
    count   instructions, which valgrind counts: the same in each run, whatever else the machine does
    time    seconds instead, of larger files; for a quiet machine
Without either, for example under sanitizers, it only checks that all files are read.
"""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

MEASURED = sys.argv[2] if len(sys.argv) > 2 else None
PROGRAM = sys.argv[1]
del sys.argv[1:]
SIZE = 2 << 20 if MEASURED == "time" else 1 << 16  # bytes of the smaller file
SIZE_OF_MEMORY = 1 << 21 if MEASURED else 1 << 16
MAX_GROWTH = 2.3
RUNS = 15 if MEASURED == "time" else 1  # the fastest counts; stops at the first sufficient one


def repeated(text, size):
    return text * (size // len(text))


def numbered(template, size):
    """As many joined copies of template % i as fit."""
    count = size // len(template % size)
    return "".join(template % i for i in range(count))


def columns(size):
    names = numbered("c%d,", size // 2)
    return names + "t_ms,jawOpen\n" + "".join("," * names.count(",") + row for row in ("0,0\n", "40,1\n"))


def gltf(keys=1, **more):
    """A face whose weights have `keys` keys; `more` adds members."""
    times, weights = struct.pack(f"<{keys}f", *range(keys)), struct.pack(f"<{keys}f", *[i % 2 for i in range(keys)])
    data = times + weights
    document = {
        "asset": {"version": "2.0"}, "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(times)},
                        {"buffer": 0, "byteOffset": len(times), "byteLength": len(weights)}],
        "accessors": [{"bufferView": i, "componentType": 5126, "type": "SCALAR", "count": keys} for i in (0, 1)],
        "meshes": [{"extras": {"targetNames": ["jawOpen"]}}], "nodes": [{"mesh": 0}],
        "animations": [{"samplers": [{"input": 0, "output": 1}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]}
    for name, value in more.items():
        document[name] = document.get(name, []) + value
    return document, data


def glb(document, data):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return (b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(data), b"BIN\0") + data)


def many_channels(size):
    document, data = gltf(accessors=[{"bufferView": 0}] * (size // 100), nodes=[{"name": "x"}] * (size // 100))
    animation = document["animations"][0]
    last = len(document["nodes"]) - 1
    animation["channels"] += [{"sampler": 0, "target": {"node": last, "path": "rotation"}}] * (size // 150)
    return glb(document, data)


def channels_of_another_mesh(size):
    document, data = gltf(meshes=[{"extras": {"targetNames": ["x"] * (size // 12)}}], nodes=[{"mesh": 1}])
    document["animations"][0]["channels"] += [{"sampler": 0, "target": {"node": 1, "path": "weights"}}] * (size // 150)
    return glb(document, data)


def keys_of_a_gltf(size):
    document, data = gltf()
    return glb(document | {f"k{i}": 0 for i in range(size // 10)}, data)


def skeleton(joints, frames):
    joint = "JOINT j { OFFSET 0 0 0 CHANNELS 0 }\n"
    return ("HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n" + joint * joints + "}\nMOTION\n" + f"Frames: {frames}\n" +
            "Frame Time: 0.01\n" + "0\n5\n" * (frames // 2))


def cues(template, size):
    count = size // len(template % (0, 0, 0, 0))
    return "".join(template % (i // 10, i % 10, (i + 1) // 10, (i + 1) % 10) for i in range(count))


LLF = "Timecode,BlendshapeCount,JawOpen,HeadYaw,HeadPitch,HeadRoll\n"
FULL_LINE = '{"t_ns":0,"head":{"pitch_rad":0.125,"yaw_rad":-0.25,"roll_rad":0.0625},"controls":{"jawOpen":0.123456,"eyeBlinkLeft":1}}\n'
FILES = {
    "csv of many columns": columns,
    "csv of empty columns": lambda size: "t_ms,jawOpen" + "," * (size // 2) + "\n0,1" + "," * (size // 2) + "\n",
    "csv of short rows": lambda size: "t_ms,jawOpen\n" + repeated("0,0\n0,1\n", size),
    "csv of full rows": lambda size: "t_ms," + ",".join(ARKIT) + "\n" + repeated("0" + ",0.1,1" * 26 + "\n", size),
    "csv in quotes": lambda size: "t_ms,jawOpen\n" + repeated('"0","0.""5"\n'.replace('""', ""), size),
    "csv of empty lines": lambda size: "t_ms,jawOpen\n0,0\n" + "\n" * size,
    "csv in UTF-16": lambda size: ("t_ms,jawOpen\n" + repeated("0,0\n0,1\n", size // 2)).encode("utf-16"),
    "Live Link Face": lambda size: LLF + repeated("10:00:00:00.000,61,0.5,0.1,0.2,0.3\n", size),
    "Live Link Face without a face": lambda size: LLF + repeated(",0\n", size // 2),
    "roblox": lambda size: "t_ms,JawDrop,Pucker\n" + repeated("0,0.1,0.5\n0,1,0\n", size),
    "visemes": lambda size: "t_ms,sil,aa\n" + repeated("0,0.1,0.9\n0,1,0\n", size),
    "json lines, short": lambda size: repeated('{"t_ns":0}\n', size),
    "json lines, full": lambda size: repeated(FULL_LINE, size),
    "json lines of many keys": lambda size: '{"t_ns":0' + numbered(',"key%d":0', size) + "}\n",
    "json lines of escaped keys": lambda size: '{"t_ns":0' + numbered(',"\\u006bey%d":0', size) + "}\n",
    "cues as json": lambda size: '{"mouthCues":[' + cues('{"start":%d.%d,"end":%d.%d,"value":"D"},', size)[:-1] + "]}",
    "cues as json among arrays": lambda size: '{"x":[[' + "0," * (size // 2) + '0]],"mouthCues":[{"start":0,"end":1,"value":"D"}]}',
    "cues as json among keys": lambda size: '{"mouthCues":[{"start":0,"end":1,"value":"D"}]' + numbered(',"%d":[]', size) + "}",
    "cues as xml": lambda size: "<rhubarbResult>" + cues('<mouthCue start="%d.%d" end="%d.%d">D</mouthCue>', size) + "</rhubarbResult>",
    "cues as xml among tags": lambda size: "<rhubarbResult>" + repeated("<a/>", size) + '<mouthCue start="0" end="1">D</mouthCue></rhubarbResult>',
    "cues as xml among comments": lambda size: "<rhubarbResult>" + repeated("<!---->\n", size) + '<mouthCue start="0" end="1">D</mouthCue></rhubarbResult>',
    "cues as tsv": lambda size: numbered("%d\tA\n", size),
    "cues of Moho": lambda size: "MohoSwitch1\n" + "".join(f"{i + 1} {'AD'[i % 2]}\n" for i in range(size // 9)),
    "glTF of many keys": keys_of_a_gltf,
    "glTF of many channels": many_channels,
    "glTF of many channels of another mesh": channels_of_another_mesh,
    "glTF of many frames": lambda size: glb(*gltf(keys=size // 8)),
    "BVH of many joints": lambda size: skeleton(size // 80, size // 4),
    "BVH of one channel": lambda size: skeleton(1, size // 2),
}
ARKIT = [f"{name}{side}" for name in ("eyeBlink eyeLookDown eyeLookIn eyeLookOut eyeLookUp eyeSquint eyeWide mouthSmile mouthFrown mouthDimple "
                                      "mouthStretch mouthPress mouthLowerDown mouthUpperUp browDown browOuterUp cheekSquint noseSneer").split()
         for side in ("Left", "Right")]
ARKIT += "jawForward jawLeft jawRight jawOpen mouthClose mouthFunnel mouthPucker mouthLeft mouthRight mouthRollLower mouthRollUpper".split()
ARKIT += "mouthShrugLower mouthShrugUpper browInnerUp cheekPuff tongueOut".split()


def run(*words):
    """Seconds of CPU time, peak memory in bytes, exit code, output."""
    with tempfile.TemporaryFile() as message:
        child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=message)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        message.seek(0)
        return used.ru_utime + used.ru_stime, used.ru_maxrss * 1024, child.returncode, message.read().decode()


def convert(*words):
    return run(PROGRAM, "convert", *words)


def work(*words):
    """Returns billions of instructions, or seconds of CPU time, then exit code and output."""
    if MEASURED != "count":
        seconds, _, code, message = convert(*words)
        return seconds, code, message
    _, _, code, message = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", PROGRAM, "convert", *words)
    return int(re.search(r"Collected : (\d+)", message)[1]) / 1e9, code, message


class Sizes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, make, *arguments):
        """The result of make(*arguments), computed in another process, because a child inherits the peak memory of its parent."""
        path = os.path.join(self.folder, name)
        child = os.fork()
        if child == 0:
            data = make(*arguments)
            with open(path, "wb") as file:
                file.write(data if isinstance(data, bytes) else data.encode())
            os._exit(0)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        return path

    def check(self, single, double, *more):
        """Growth from one file to another, which is twice as large, and the work for the latter."""
        least = [float("inf")] * 2
        for _ in range(RUNS):
            for i, path in enumerate((single, double)):
                done, code, message = work(path, "-", "--to", "csv", *more)
                self.assertEqual(code, 0, message)
                least[i] = min(least[i], done)
            growth = least[1] / max(least[0], 1e-3)
            if not MEASURED or growth <= MAX_GROWTH:
                return growth, least[1]
        self.fail(f"{growth:.2f} times: {least[0]:.3f}, {least[1]:.3f}")

    def test_twice_the_input_takes_twice_the_work(self):
        for name, make in FILES.items():
            with self.subTest(name):
                growth, done = self.check(self.file("single", make, SIZE), self.file("double", make, 2 * SIZE))
                print(f"{name}: {growth:.2f} times, {done:.2f} {'billion instructions' if MEASURED == 'count' else 's'}", flush=True)

    def test_memory_is_a_small_multiple_of_the_input(self):
        for name, make in FILES.items():
            with self.subTest(name):
                path = self.file("large", make, SIZE_OF_MEMORY)
                _, memory, code, message = convert(path, "-", "--to", "csv")
                self.assertEqual(code, 0, message)
                if MEASURED:
                    self.assertLessEqual(memory, 8 * os.path.getsize(path) + (64 << 20), (memory >> 20, os.path.getsize(path)))

    def test_twice_the_faces_at_a_rate_take_twice_the_work(self):
        def faces(count):
            lines = [{"t_ns": int(t * 1e9), "face_id": face, "controls": {"jawOpen": 0.5}} for t in (0, 100) for face in range(1, count + 1)]
            return "".join(json.dumps(line) + "\n" for line in lines)
        self.check(self.file("single", faces, 20), self.file("double", faces, 40), "--fps", {"time": "100", "count": "10", None: "1"}[MEASURED])

    def test_the_total_of_all_faces_is_limited(self):
        lines = [{"t_ns": int(t * 1e9), "face_id": face} for t in (0, 5000) for face in range(1, 41)]
        path = self.file("faces.jsonl", lambda: "".join(json.dumps(line) + "\n" for line in lines))
        _, _, code, message = convert(path, "-", "--to", "csv", "--fps", "100")
        self.assertEqual(code, 2)
        self.assertIn("--fps: more than ten million frames", message)
        path = self.file("crowd.jsonl", numbered, '{"t_ns":0,"face_id":%d}\n', 100000)
        _, _, code, message = convert(path, "-", "--to", "csv", "--fps", "10")
        self.assertEqual(code, 2)
        self.assertIn("--fps: more than 1000 faces; select one with --face", message)


if __name__ == "__main__":
    if MEASURED == "count" and not shutil.which("valgrind"):
        print("SKIPPED: needs valgrind")
        sys.exit(77)
    unittest.main()
