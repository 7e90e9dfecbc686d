"""Avatars like those of users: a head of one triangle whose morph targets have names, on a body whose arms point sideways."""
import json
import struct
import zlib

TOP, CHIN = 1.7, 1.4  # y of the head
FACE = 2  # node
TRIANGLE = [-0.1, CHIN, 0, 0.1, CHIN, 0, 0, TOP, 0]


def glb(document, data):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
            struct.pack("<II", len(data), 0x004E4942) + data)


def avatar(names, data=b"", **more):
    """`more`: members of the document. `data`: behind the 72 bytes of the triangle and its morph target."""
    vec3 = {"componentType": 5126, "count": 3, "type": "VEC3"}
    nodes = [{"name": "root", "children": [1, 3, 4, 6]}, {"name": "Head", "children": [FACE], "translation": [0, CHIN, 0]},
             {"name": "face", "mesh": 0, "translation": [0, -CHIN, 0]}, {"name": "body", "mesh": 0, "translation": [0, -CHIN, 0], "scale": [30, 0.8, 1]}]
    for side, x in (("Left", 0.2), ("Right", -0.2)):
        nodes += [{"name": side + "Arm", "translation": [x, 1.3, 0], "children": [len(nodes) + 1]}, {"name": side + "ForeArm", "translation": [2.5 * x, 0, 0]}]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}] * len(names)}], "weights": [0] * len(names),
                    "extras": {"targetNames": names}}],
        "buffers": [{"byteLength": 72 + len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36}],
        "accessors": [{**vec3, "bufferView": 0, "min": [-0.1, CHIN, 0], "max": [0.1, TOP, 0]},
                      {**vec3, "bufferView": 1, "min": [0.01] * 3, "max": [0.01] * 3}]}
    if more.pop("texture", False):
        document["bufferViews"].append({"buffer": 0, "byteOffset": 72, "byteLength": len(data)})
        document["images"] = [{"bufferView": 2, "mimeType": "image/png"}]
        document["textures"], document["materials"] = [{"source": 0}], [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        document["meshes"][0]["primitives"][0]["material"] = 0
    return glb({**document, **more}, struct.pack("<18f", *TRIANGLE, *[0.01] * 9) + data)


def textured(names):
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)) +
           chunk(b"IDAT", zlib.compress(b"\0\0\xff\0\0\xff\0" * 2)) + chunk(b"IEND", b""))
    return avatar(names, png, texture=True)


def vrm(names):
    """VRM 1.0 whose presets `aa` and `blinkLeft` move the first two targets."""
    body = ("hips spine leftUpperLeg leftLowerLeg leftFoot rightUpperLeg rightLowerLeg rightFoot leftUpperArm leftLowerArm leftHand "
            "rightUpperArm rightLowerArm rightHand").split()
    bind = lambda index: {"morphTargetBinds": [{"node": FACE, "index": index, "weight": 1}]}
    return avatar(names, extensionsUsed=["VRMC_vrm"], extensions={"VRMC_vrm": {
        "specVersion": "1.0", "meta": {"name": "test", "version": "1", "authors": ["mien"], "licenseUrl": "https://vrm.dev/licenses/1.0/"},
        "humanoid": {"humanBones": {**{name: {"node": 0} for name in body}, "head": {"node": 1}}},
        "expressions": {"preset": {"aa": bind(0), "blinkLeft": bind(1)}}}})
