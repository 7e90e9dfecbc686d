"""Tests of glTF in `mien convert`, with a reader of its own.

usage: convert_gltf_test.py MIEN_PROGRAM [FRAMES]
"""
import base64
import csv
import json
import math
import os
import struct
import subprocess
import unittest

from conversions import ARKIT, PROGRAM, ConvertTestCase, matrix_of_quaternion, rotation_matrix


def glb_chunks(data):
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    chunks, at = [], 12
    while at < length:
        size, kind = struct.unpack_from("<I4s", data, at)
        chunks.append((kind, data[at + 8:at + 8 + size]))
        at += 8 + size
        assert at % 4 == 0
    assert [kind for kind, _ in chunks] == [b"JSON", b"BIN\0"]
    return json.loads(chunks[0][1]), chunks[1][1]


def accessor(document, data, index):
    a = document["accessors"][index]
    view = document["bufferViews"][a["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a["type"]]
    assert a["componentType"] == 5126
    values = struct.unpack_from(f"<{a['count'] * width}f", data, view.get("byteOffset", 0) + a.get("byteOffset", 0))
    return [values[i:i + width] for i in range(0, len(values), width)]


def to_f32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


class ConvertGltf(ConvertTestCase):
    def check_gltf(self, document, data, frames):
        animation = document["animations"][0]
        names = document["meshes"][0]["extras"]["targetNames"]
        self.assertEqual(names, ARKIT)
        self.assertEqual(document["meshes"][0]["weights"], [0] * len(ARKIT))
        nodes = [node["name"] for node in document["nodes"]]
        found = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            self.assertEqual(sampler["interpolation"], "LINEAR")
            times = [t[0] for t in accessor(document, data, sampler["input"])]
            bounds = document["accessors"][sampler["input"]]
            self.assertEqual((bounds["min"], bounds["max"]), ([times[0]], [times[-1]]))
            self.assertTrue(all(a < b for a, b in zip(times, times[1:])))
            found[nodes[channel["target"]["node"]], channel["target"]["path"]] = times, accessor(document, data,
                                                                                                 sampler["output"])
        times, weights = found["face", "weights"]
        kept, last = [], -1.0
        for frame in frames:
            if to_f32(frame["t_ns"] * 1e-9) > last:
                last = to_f32(frame["t_ns"] * 1e-9)
                kept.append(frame)
        self.assertEqual(times, [to_f32(frame["t_ns"] * 1e-9) for frame in kept])
        flat = [w[0] for w in weights]
        for i, frame in enumerate(kept):
            self.assertEqual(flat[52 * i:52 * i + 52], [to_f32(frame["controls"][name]) for name in ARKIT])
        seen = [frame for frame in kept if "head" in frame]
        for (node, path), get in ((("head", "rotation"), lambda f: f["head"]), (("leftEye", "rotation"),
                                                                                lambda f: f["eyes"]["left"]),
                                  (("rightEye", "rotation"), lambda f: f["eyes"]["right"])):
            keys = dict(zip(*found[node, path]))
            for frame in seen:
                q = keys[to_f32(frame["t_ns"] * 1e-9)]
                self.assertAlmostEqual(sum(part * part for part in q), 1, places=6)
                for row, wanted in zip(matrix_of_quaternion(*q), rotation_matrix(get(frame))):
                    for a, b in zip(row, wanted):
                        self.assertAlmostEqual(a, b, places=6)
        self.assertEqual(found["head",
                               "translation"][1], [tuple(to_f32(v) for v in frame["position_m"]) for frame in seen])

    def test_gltf(self):
        self.convert("source.jsonl", "clip.glb")
        with open(self.path("clip.glb"), "rb") as file:
            self.check_gltf(*glb_chunks(file.read()), self.frames)
        few = self.frames[:500]
        self.write("few.jsonl", "".join(json.dumps(frame) + "\n" for frame in few))
        self.convert("few.jsonl", "few.gltf")
        document = json.loads(self.read("few.gltf"))
        uri = document["buffers"][0]["uri"]
        data = base64.b64decode(uri.removeprefix("data:application/octet-stream;base64,"), validate=True)
        self.assertEqual(len(data), document["buffers"][0]["byteLength"])
        self.check_gltf(document, data, few)

    def test_gltf_round_trips(self):
        self.convert("source.jsonl", "back.glb")
        self.convert("back.glb", "back.jsonl")
        kept, last = [], -1.0
        for frame in self.frames:
            if to_f32(frame["t_ns"] * 1e-9) > last:
                last = to_f32(frame["t_ns"] * 1e-9)
                kept.append(frame)
        for frame, after in zip(kept, self.frames_of("back.jsonl"), strict=True):
            self.assertEqual(to_f32(after["t_ns"] * 1e-9), to_f32(frame["t_ns"] * 1e-9))
            as_f32 = lambda controls: {k: to_f32(v) for k, v in controls.items()}
            self.assertEqual(as_f32(after["controls"]), as_f32(frame["controls"]))
            self.assertEqual(("head" in after, after["status"]), ("head" in frame, frame["status"]))
        with open(self.path("back.glb"), "rb") as file:
            once = file.read()
        self.convert("back.glb", "back.again.glb")
        with open(self.path("back.again.glb"), "rb") as file:
            again = file.read()
        _, a = glb_chunks(once)
        _, b = glb_chunks(again)
        self.assertEqual(len(a), len(b))
        differ = [abs(x - y)
                  for x, y in zip(struct.unpack(f"<{len(a) // 4}f", a), struct.unpack(f"<{len(b) // 4}f", b))]
        self.assertLess(max(differ), 1e-6)  # rotations are converted to angles; the rest is equal

    def test_gltf_of_other_programs(self):
        times, weights = struct.pack("<2f", 0, 1), struct.pack("<4f", 0, 1, 0.5, 0.25)
        turn = struct.pack("<8f", 0, 0, 0, 1, 0, math.sin(0.25), 0, math.cos(0.25))
        data = times + weights + turn
        document = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
            "bufferViews": [{"buffer": 0, "byteOffset": o, "byteLength": n} for o, n in ((0, 8), (8, 16), (24, 32))],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 2},
                          {"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 4},
                          {"bufferView": 2, "componentType": 5126, "type": "VEC4", "count": 2}],
            "meshes": [{"primitives": [], "extras": {"targetNames": ["jawOpen", "mouthSmile_L"]}}],
            "nodes": [{"mesh": 0}, {"name": "mixamorig:Head"}],
            "animations": [{"samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 2}],
                            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}},
                                         {"sampler": 1, "target": {"node": 1, "path": "rotation"}}]}]}
        self.write("other.gltf", json.dumps(document, indent=1))
        self.convert("other.gltf", "other.jsonl")
        first, last = self.frames_of("other.jsonl")
        self.assertEqual((first["controls"], last[
            "controls"]), ({"jawOpen": 0, "mouthSmileLeft": 1}, {"jawOpen": 0.5, "mouthSmileLeft": 0.25}))
        self.assertAlmostEqual(last["head"]["yaw_rad"], 0.5, places=6)

    def test_gltf_tracks_with_times_of_their_own(self):
        """The head has keys at 0 and 1 s only; it is interpolated at the times of the weights. Unknown targets are
        ignored."""
        parts = [struct.pack("<3f", 0, 0.25, 1), struct.pack("<6f", 0, 7, 0.75, 7, 1, 7), struct.pack("<2f", 0, 1),
                 struct.pack("<8f", 0, 0, 0, 1, 0, math.sin(0.25), 0, math.cos(0.25))]
        data, starts = b"".join(parts), [sum(map(len, parts[:i])) for i in range(len(parts))]
        kinds = (("SCALAR", 3), ("SCALAR", 6), ("SCALAR", 2), ("VEC4", 2))
        document = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
            "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": len(part)}
                            for start, part in zip(starts, parts)],
            "accessors": [{"bufferView": i, "componentType": 5126, "type": kind, "count": count}
                          for i, (kind, count) in enumerate(kinds)],
            "meshes": [{"primitives": [], "extras": {"targetNames": ["jawOpen", "browRoll"]}}],
            "nodes": [{"mesh": 0}, {"name": "Head"}],
            "animations": [{"samplers": [{"input": 0, "output": 1}, {"input": 2, "output": 3}],
                            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}},
                                         {"sampler": 1, "target": {"node": 1, "path": "rotation"}}]}]}
        self.write("times.gltf", json.dumps(document))
        self.assertNotIn("clamped", self.convert("times.gltf", "times.jsonl"))
        frames = self.frames_of("times.jsonl")
        self.assertEqual([frame["t_ns"] for frame in frames], [0, 250_000_000, 1_000_000_000])
        self.assertEqual([frame["controls"]["jawOpen"] for frame in frames], [0, 0.75, 1])
        for frame, yaw in zip(frames, (0, 0.125, 0.5)):
            self.assertAlmostEqual(frame["head"]["yaw_rad"], yaw, places=6)

    def gltf_document(self, uri, weight_type=5126, extension=None):
        """A face with keys at 0 and 1 s, and its data."""
        pack = {5126: "<4f", 5121: "<4B", 5123: "<4H", 5122: "<4h"}[weight_type]
        most = {5126: 1, 5121: 255, 5123: 65535, 5122: 32767}[weight_type]
        data = struct.pack("<2f", 0, 1) + struct.pack(pack, *[most if weight == 1 else 0 for weight in (0, 1, 1, 0)])
        view = {"buffer": 0, "byteOffset": 8,
                "byteLength": len(data) - 8} | ({"extensions": {extension: {"buffer": 0}}} if extension else {})
        return {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(data), "uri": uri}],
                "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 8}, view],
                "accessors": [{"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 2},
                              {"bufferView": 1, "componentType": weight_type, "normalized": weight_type != 5126,
                               "type": "SCALAR", "count": 4}],
                "meshes": [{"primitives": [], "extras": {"targetNames": ["jawOpen", "mouthSmile_L"]}}],
                "nodes": [{"mesh": 0}], "animations": [{"samplers": [{"input": 0, "output": 1}],
                                "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]}, data

    def test_gltf_with_external_data(self):
        os.makedirs(self.path("scene/parts"))
        for uri, name in (("data.bin", "data.bin"), ("parts/my%20data.bin", "parts/my data.bin"),
                          ("$41%.bin", "$41%.bin"), ("./parts/%e4%bd%a0.bin", "parts/\u4f60.bin")):
            document, data = self.gltf_document(uri)
            with open(self.path("scene/" + name), "wb") as file:
                file.write(data + b"more")
            self.write("scene/face.gltf", json.dumps(document))
            self.convert("scene/face.gltf", "beside.jsonl")
            first, last = self.frames_of("beside.jsonl")
            self.assertEqual((first["controls"], last[
                "controls"]), ({"jawOpen": 0, "mouthSmileLeft": 1}, {"jawOpen": 1, "mouthSmileLeft": 0}))
        outside = self.path("outside.bin")
        with open(outside, "wb") as file:
            file.write(data)
        with open(self.path("scene/short.bin"), "wb") as file:
            file.write(data[:-1])
        os.mkfifo(self.path("scene/pipe.bin"))
        for uri, why in (("../outside.bin", "not in the folder of the file"), ("parts/../../outside.bin",
                                                                               "not in the folder of the file"),
                         (outside, "not in the folder of the file"), ("file://" + outside,
                                                                      "not in the folder of the file"),
                         ("none.bin", "no such file"), ("short.bin", f"shorter than {len(data)} bytes"),
                         ("parts", "not a regular file"),
                         ("pipe.bin", "not a regular file")):
            self.write("scene/bad.gltf", json.dumps(self.gltf_document(uri)[0]))
            code, message = self.refused("scene/bad.gltf", "bad.jsonl")
            self.assertEqual(code, 3)
            self.assertIn(f"uri: '{uri[:40]}': {why}", message)
        done = subprocess.run([PROGRAM, "convert", "-", self.path("bad.jsonl")], capture_output=True, text=True,
                              input=json.dumps(self.gltf_document("data.bin")[0]))
        self.assertEqual(done.returncode, 3)
        self.assertIn("uri: 'data.bin': no folder to search", done.stderr)

    def test_compressed_gltf(self):
        for weight_type in (5121, 5122, 5123):
            document, data = self.gltf_document("data:;base64,", weight_type)
            document["buffers"][0]["uri"] += base64.b64encode(data).decode()
            # Data that are not animated may be compressed, because they are not read.
            document["extensionsRequired"] = ["KHR_draco_mesh_compression", "KHR_texture_basisu",
                                              "KHR_mesh_quantization"]
            document["meshes"][0]["primitives"] = [{"extensions": {"KHR_draco_mesh_compression": {"bufferView": 7}}}]
            document["images"] = [{"bufferView": 9, "mimeType": "image/ktx2"}]
            document["buffers"].append({"byteLength": 100})
            self.write("small.gltf", json.dumps(document))
            self.convert("small.gltf", "small.jsonl")
            first, last = self.frames_of("small.jsonl")
            self.assertEqual((first["controls"], last[
                "controls"]), ({"jawOpen": 0, "mouthSmileLeft": 1}, {"jawOpen": 1, "mouthSmileLeft": 0}))
        for extension in ("EXT_meshopt_compression", "KHR_meshopt_compression"):
            document, data = self.gltf_document("data:;base64,", extension=extension)
            document["buffers"][0]["uri"] += base64.b64encode(data).decode()
            self.write("packed.gltf", json.dumps(document))
            code, message = self.refused("packed.gltf", "packed.jsonl")
            self.assertEqual(code, 3)
            self.assertIn(
                f"bufferView: compressed with {extension}, which is not supported; export the animation without it",
                message)

    def test_cues_hold_in_gltf(self):
        self.write("cues.tsv", "0.00\tX\n1.00\tD\n2.00\tX\n3.00\tX\n")
        self.convert("cues.tsv", "cues.gltf")
        sampler, = {s["interpolation"] for s in json.loads(self.read("cues.gltf"))["animations"][0]["samplers"]}
        self.assertEqual(sampler, "STEP")
        self.convert("cues.tsv", "cues.csv", "--fps", "10")
        self.convert("cues.gltf", "held.csv", "--fps", "10")
        jaws = [[row["jawOpen"] for row in csv.DictReader(self.read(name).splitlines())]
                for name in ("cues.csv", "held.csv")]
        self.assertEqual(jaws[0], jaws[1])
        self.assertEqual(len(set(jaws[0])), 2)


if __name__ == "__main__":
    unittest.main()
