"""Tests of the add-on in Blender's Python module.

usage: in_blender_test.py MIEN_PROGRAM SOURCE_FOLDER ZIP AVATAR_GLB      in an environment with bpy
"""

import csv
import os
import socket
import subprocess
import sys
import tempfile
import time
import unittest

RESOURCES = tempfile.TemporaryDirectory()
os.environ["BLENDER_USER_RESOURCES"] = RESOURCES.name

import blender_scene as stage  # noqa: E402
import bpy  # noqa: E402
from mathutils import Matrix, Quaternion, Vector  # noqa: E402

PROGRAM, SOURCE, ZIP, AVATAR = sys.argv[1:5]
del sys.argv[1:5]
CLIP = SOURCE + "/tests/data/demo.mp4"
MODELS = ("--models", SOURCE + "/models", "--quiet")
ANGLES = ("pitch_rad", "yaw_rad", "roll_rad")
FILES = {}


def run(*arguments):
    subprocess.run([PROGRAM, *arguments], check=True, timeout=300)


def setUpModule():
    stage.install(ZIP)
    FILES["csv"], FILES["llf"] = (os.path.join(RESOURCES.name, name) for name in ("demo.csv", "demo.llf.csv"))
    run("track", CLIP, *MODELS, "-o", FILES["csv"], "-o", FILES["llf"])


def rows(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def supported(table):
    """Names of the controls that have values."""
    names = list(table[0])
    return [name for name in names[names.index("eyeBlinkLeft") :] if any(row[name] for row in table)]


def key_path(name):
    return (f'key_blocks["{name}"].value', 0)


def shape_mesh(scene, name, key_names):
    """A tetrahedron whose shape keys each move one corner up."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [], [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
    made = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(made)
    made.shape_key_add(name="Basis")
    for name in key_names:
        key = made.shape_key_add(name=name)
        key.data[0].co.z, key.value = 1.0, 0.0  # Blender 5 adds keys with the value 1
    return made


def rotation(angles):
    """R = Ry(yaw) Rx(pitch) Rz(roll) in mien's axes, as matrices, independent of the add-on."""
    pitch, yaw, roll = angles
    return Matrix.Rotation(yaw, 3, "Y") @ Matrix.Rotation(pitch, 3, "X") @ Matrix.Rotation(roll, 3, "Z")


# Mien's axes (left, up, front) in the space of a character that faces -Y.
TO_BLENDER = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))


class InScene(unittest.TestCase):
    def setUp(self):
        self.scene = stage.empty_scene()

    def assert_same_rotation(self, actual, expected, delta=1e-5):
        self.assertLess(max(abs(a - b) for x, y in zip(actual, expected) for a, b in zip(x, y)), delta)

    def import_csv(self, path, **options):
        return bpy.ops.mien_face.import_csv(filepath=path, **options)

    def assert_fails(self, what, call):
        with self.assertRaises(RuntimeError) as caught:
            call()
        self.assertIn(what, str(caught.exception))


class Import(InScene):
    def test_keys_are_those_of_the_file(self):
        self.scene.render.fps, self.scene.render.fps_base = 24, 1.001
        mesh, armature = stage.load_avatar(AVATAR)
        settings = stage.choose(self.scene, mesh)
        self.assertEqual((settings.head_object, settings.head_bone), (armature, "Head"))
        self.import_csv(FILES["csv"], start_frame=5.0)
        table, found = rows(FILES["csv"]), stage.fcurves(mesh.data.shape_keys)
        controls = supported(table)
        self.assertGreater(len(controls), 40)
        self.assertEqual(found.keys(), {key_path(name) for name in controls})
        for name in controls:
            expected = [
                (5.0 + float(row["t_ms"]) / 1000.0 * 24 / 1.001, float(row[name])) for row in table if row[name]
            ]
            for (frame, value), (exact_frame, exact) in zip(stage.keys(found[key_path(name)]), expected, strict=True):
                self.assertAlmostEqual(value, exact, delta=1e-6)
                self.assertAlmostEqual(frame, exact_frame, delta=1e-4)
        self.assertEqual({point.interpolation for point in found[key_path("jawOpen")].keyframe_points}, {"LINEAR"})
        self.assert_head_moves(armature, [row for row in table if row["yaw_rad"]])

    def assert_head_moves(self, armature, table):
        bone, turned = armature.pose.bones["Head"], 0.0
        self.assertEqual(len(stage.fcurves(armature)), 4)
        for row in table[::40]:
            time = 5.0 + float(row["t_ms"]) / 1000.0 * 24 / 1.001
            self.scene.frame_set(int(time), subframe=time % 1.0)
            expected = TO_BLENDER @ rotation([float(row[name]) for name in ANGLES]) @ TO_BLENDER.transposed()
            shown = bone.matrix.to_3x3() @ bone.bone.matrix_local.to_3x3().inverted()
            self.assert_same_rotation(shown, expected, 1e-3)  # times are stored in single precision
            turned = max(turned, abs(float(row["yaw_rad"])))
        self.assertGreater(turned, 0.1)

    def test_the_mesh_moves(self):
        mesh, _ = stage.load_avatar(AVATAR)
        settings = stage.choose(self.scene, mesh)
        settings.use_head = False
        self.import_csv(FILES["csv"])
        open_row = max(rows(FILES["csv"]), key=lambda row: float(row["jawOpen"]))
        rest = [vertex.co.copy() for vertex in mesh.data.vertices]
        expected = [position.copy() for position in rest]
        for block in mesh.data.shape_keys.key_blocks[1:]:
            weight = float(open_row[block.name] or 0.0)
            for i, point in enumerate(block.data):
                expected[i] += weight * (point.co - rest[i])
        time = 1.0 + float(open_row["t_ms"]) / 1000.0 * self.scene.render.fps
        self.scene.frame_set(int(time), subframe=time % 1.0)
        shown = stage.vertices(mesh)
        for position, at in zip(shown, expected, strict=True):
            self.assertLess((position - mesh.matrix_world @ at).length, 1e-3)
        chin = min(range(len(rest)), key=lambda i: (rest[i] - Vector((0.0, -0.95, -1.05))).length)
        self.assertLess(shown[chin].z, rest[chin].z - 0.02)  # the avatar is 2 high

    def test_live_link_face(self):
        mesh = shape_mesh(self.scene, "Face", ["jawOpen", "mouthSmile_L"])
        stage.choose(self.scene, mesh)
        self.import_csv(FILES["llf"])
        found, table = stage.fcurves(mesh.data.shape_keys), rows(FILES["llf"])
        for key, column in (("jawOpen", "JawOpen"), ("mouthSmile_L", "MouthSmileLeft")):
            for (_, value), row in zip(stage.keys(found[key_path(key)]), table, strict=True):
                self.assertAlmostEqual(value, float(row[column]), delta=1e-6)
        self.assertEqual(stage.keys(found[key_path("jawOpen")])[0][0], 1.0)
        self.assertAlmostEqual(
            stage.keys(found[key_path("jawOpen")])[-1][0], 1.0 + 239 / 30 * self.scene.render.fps, delta=0.05
        )

    def test_scales(self):
        mesh, armature = shape_mesh(self.scene, "Face", ["jawOpen"]), stage.head_armature()
        settings = stage.choose(self.scene, mesh)
        settings.head_object, settings.head_bone, settings.control_scale, settings.head_scale = (
            armature,
            "Head",
            2.0,
            0.0,
        )
        self.import_csv(FILES["csv"])
        for (_, value), row in zip(
            stage.keys(stage.fcurves(mesh.data.shape_keys)[key_path("jawOpen")]), rows(FILES["csv"]), strict=True
        ):
            self.assertAlmostEqual(value, 2.0 * float(row["jawOpen"]), delta=1e-6)
        for _, value in stage.keys(stage.fcurves(armature)['pose.bones["Head"].rotation_quaternion', 0]):
            self.assertAlmostEqual(value, 1.0, delta=1e-6)

    def test_present_actions(self):
        mesh, armature = shape_mesh(self.scene, "Face", ["jawOpen", "Fat"]), stage.head_armature()
        settings = stage.choose(self.scene, mesh)
        settings.head_object, settings.head_bone = armature, "Head"
        armature.pose.bones["Neck"].keyframe_insert("location", frame=3)
        body = armature.animation_data.action
        self.import_csv(FILES["csv"], action="merge")
        self.import_csv(FILES["csv"], action="merge")
        self.assertEqual(armature.animation_data.action, body)
        self.assertEqual(len(stage.fcurves(armature)), 3 + 4)
        self.import_csv(FILES["csv"], action="new")
        self.assertNotEqual(armature.animation_data.action, body)
        self.assertTrue(body.use_fake_user)
        self.assertEqual((len(stage.fcurves(armature)), len(stage.fcurves(mesh.data.shape_keys))), (4, 1))

    def test_nothing_else_is_touched(self):
        mesh, other, armature = (
            shape_mesh(self.scene, "Face", ["jawOpen"]),
            shape_mesh(self.scene, "Other", ["jawOpen"]),
            stage.head_armature(),
        )
        settings = stage.choose(self.scene, mesh)
        settings.head_object, settings.head_bone = armature, "Head"
        before = (self.scene.frame_end, self.scene.frame_current, self.scene.render.fps)
        self.import_csv(FILES["csv"])
        self.scene.frame_set(100)
        self.assertGreater(mesh.data.shape_keys.key_blocks["jawOpen"].value, 0.0)
        self.assertEqual(other.data.shape_keys.key_blocks["jawOpen"].value, 0.0)
        self.assertIsNone(other.data.shape_keys.animation_data)
        self.assertEqual(armature.pose.bones["Neck"].matrix_basis, Matrix())
        self.scene.frame_set(before[1])
        self.assertEqual((self.scene.frame_end, self.scene.frame_current, self.scene.render.fps), before)

    def test_faults_change_nothing(self):
        mesh = shape_mesh(self.scene, "Face", ["jawOpen"])
        bad = os.path.join(RESOURCES.name, "bad.csv")
        call = lambda **options: self.import_csv(bad, **options)
        for content, what in (
            ("t_ms,jawOpen\n0,x\n", "bad.csv: line 2: jawOpen: 'x' is not a number"),
            ("", "bad.csv: line 1: empty file"),
            ("t_ms,tongueOut\n0,1\n", "no shape key"),
            ("t_ms,jawOpen\n0,1\n1e12,1\n", "beyond Blender's last"),
        ):
            with open(bad, "w") as file:
                file.write(content)
            stage.choose(self.scene, mesh)
            self.assert_fails(what, call)
        self.assert_fails("No such file", lambda: self.import_csv(bad + "x"))
        self.scene.mien_face.head_object, self.scene.mien_face.head_bone = stage.head_armature(), "Skull"
        self.assert_fails("Rig has no bone 'Skull'", lambda: self.import_csv(FILES["csv"]))
        self.assertEqual(len(bpy.data.actions), 0)

    def test_starting_at_the_first_row(self):
        mesh = shape_mesh(self.scene, "Face", ["jawOpen"])
        stage.choose(self.scene, mesh)
        late = os.path.join(RESOURCES.name, "late.csv")
        with open(late, "w") as file:
            file.write("t_ms,jawOpen\n1e12,0\n1000000001000,1\n")
        self.import_csv(late, origin="first", start_frame=10.0)
        self.assertEqual(
            stage.keys(stage.fcurves(mesh.data.shape_keys)[key_path("jawOpen")]),
            [(10.0, 0.0), (10.0 + self.scene.render.fps, 1.0)],
        )


class Heads(InScene):
    def assert_turns(self, settings, shown_rotation):
        frame = stage.module("frame").Frame(0.0, {}, stage.module("rotation").of_angles(0.3, 0.5, -0.2))
        stage.module("targets").apply(settings, frame)
        bpy.context.view_layer.update()
        self.assert_same_rotation(shown_rotation(), TO_BLENDER @ rotation((0.3, 0.5, -0.2)) @ TO_BLENDER.transposed())

    def test_bones_in_every_rotation_mode(self):
        armature = stage.head_armature()
        settings, bone = self.scene.mien_face, armature.pose.bones["Head"]
        settings.head_object, settings.head_bone = armature, "Head"
        for mode in ("QUATERNION", "XYZ", "ZYX", "AXIS_ANGLE"):
            bone.rotation_mode = mode
            self.assert_turns(settings, lambda: bone.matrix.to_3x3() @ bone.bone.matrix_local.to_3x3().inverted())

    def test_objects_keep_their_own_rotation(self):
        head = shape_mesh(self.scene, "Face", ["jawOpen"])
        self.scene.mien_face.head_object = head
        for mode in ("QUATERNION", "XYZ", "ZXY"):
            head.rotation_mode = mode
            head.rotation_quaternion, head.rotation_euler = Quaternion((0.8, 0.6, 0.0, 0.0)), (0.4, 0.5, 0.6)
            rest = head.rotation_quaternion.to_matrix() if mode == "QUATERNION" else head.rotation_euler.to_matrix()
            self.assert_turns(self.scene.mien_face, lambda: head.matrix_world.to_3x3() @ rest.inverted())

    def test_an_object_with_axis_and_angle_is_rejected(self):
        head = shape_mesh(self.scene, "Face", ["jawOpen"])
        stage.choose(self.scene, head).head_object = head
        head.rotation_mode = "AXIS_ANGLE"
        self.assert_fails("rotates by axis and angle", lambda: self.import_csv(FILES["csv"]))


class Live(InScene):
    def setUp(self):
        super().setUp()
        self.live = stage.module("live")
        self.addCleanup(self.live.stop)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.sender.close)

    def start(self, *key_names):
        mesh = shape_mesh(self.scene, "Face", key_names)
        stage.choose(self.scene, mesh).port = self.port
        bpy.ops.mien_face.start()
        return mesh.data.shape_keys.key_blocks

    def send(self, data):
        self.sender.sendto(data, ("127.0.0.1", self.port))
        self.assertIsNotNone(self.live.tick())

    def port_is_free(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("127.0.0.1", self.port))
            except OSError:
                return False
        return True

    def test_a_tracked_clip(self):
        """Every frame of `mien live` is recorded with the values on its standard output, and shown."""
        mesh, armature = stage.load_avatar(AVATAR)
        settings = stage.choose(self.scene, mesh)
        settings.port = self.port
        bpy.ops.mien_face.start()
        bpy.ops.mien_face.record()
        other = stage.module("receiver").Receiver(0)
        self.addCleanup(other.close)
        sent = os.path.join(RESOURCES.name, "live.jsonl")
        with open(sent, "w") as file:
            sender = subprocess.Popen(
                [
                    PROGRAM,
                    "live",
                    *MODELS,
                    "--camera",
                    "test:" + CLIP,
                    "--send",
                    f"jsonl://:{self.port}",
                    "--send",
                    f"llf://:{other.port}",
                    "--send",
                    "-",
                ],
                stdout=file,
            )
        live_link, deadline = [], time.monotonic() + 240.0
        while sender.poll() is None and time.monotonic() < deadline:
            self.live.tick()
            live_link += other.poll()
            time.sleep(0.01)
        self.assertEqual(sender.wait(1), 0)
        self.live.tick()
        live_link += other.poll()
        run("convert", sent, sent + ".csv", "--quiet")
        table = rows(sent + ".csv")
        self.assertGreater(len(table), 20)
        for name in supported(table):
            self.assertAlmostEqual(
                mesh.data.shape_keys.key_blocks[name].value, float(table[-1][name]), delta=1e-6, msg=name
            )
        self.assert_live_link(live_link, table)
        bpy.ops.mien_face.finish_recording()
        self.assert_recorded(mesh, armature, table)

    def assert_live_link(self, frames, table):
        for frame, row in zip(frames, table, strict=True):
            for name, value in frame.values["arkit"].items():
                self.assertAlmostEqual(value, float(row[name] or 0.0), delta=1e-6)

    def assert_recorded(self, mesh, armature, table):
        found = stage.fcurves(mesh.data.shape_keys)
        start_ms, fps = float(table[0]["t_ms"]), self.scene.render.fps
        for name in ("jawOpen", "eyeBlinkLeft", "mouthSmileRight"):
            got = stage.keys(found[key_path(name)])
            for (frame, value), row in zip(got, table, strict=True):
                self.assertAlmostEqual(value, float(row[name]), delta=1e-6)
                self.assertAlmostEqual(frame - got[0][0], (float(row["t_ms"]) - start_ms) / 1000.0 * fps, delta=1e-2)
        self.assertEqual(len(stage.fcurves(armature)), 4)
        self.assertGreater(max(value for _, value in stage.keys(found[key_path("jawOpen")])), 0.2)

    def test_values_arrive_and_malformed_packets_do_not(self):
        blocks = self.start("jawOpen", "A")
        self.send(b'{"t_ns":1,"controls":{"jawOpen":0.75}}')
        self.assertEqual(blocks["jawOpen"].value, 0.75)
        for data in (b"", b"garbage", b'{"t_ns":2,"controls":{"jawOpen":9}}', b"\6\0\0", os.urandom(2000)):
            self.send(data)
        self.assertEqual(blocks["jawOpen"].value, 0.75)
        self.assertEqual([problem for _, problem in self.live.status()], [False, True])
        self.assertIn("5 packets rejected: unknown packet (2000 bytes)", self.live.status()[1][0])
        self.send(b'{"t_ns":3,"controls":{"jawOpen":0.5}}')
        self.assertEqual(blocks["jawOpen"].value, 0.5)

    def test_visemes_and_vrm_follow_from_controls(self):
        blocks = self.start("A", "I", "U", "Blink_L")
        self.send(b'{"t_ns":1,"controls":{"jawOpen":0.5,"eyeBlinkLeft":1,"mouthPucker":0.25}}')
        self.assertEqual([blocks[name].value for name in ("A", "I", "U", "Blink_L")], [0.5, 0.0, 0.25, 1.0])

    def test_deleted_objects_are_no_problem(self):
        self.start("jawOpen")
        armature = stage.head_armature()
        self.scene.mien_face.head_object, self.scene.mien_face.head_bone = armature, "Head"
        packet = b'{"t_ns":1,"controls":{"jawOpen":0.5},"head":{"pitch_rad":0.1,"yaw_rad":0,"roll_rad":0}}'
        self.send(packet)
        self.scene.mien_face.head_bone = "gone"
        self.send(packet)
        self.assertIn(("head: Rig has no bone 'gone'", True), self.live.status())
        bpy.data.objects.remove(armature)
        bpy.data.objects.remove(bpy.data.objects["Face"])
        self.send(packet)
        self.assertFalse(any(problem for _, problem in self.live.status()))

    def test_the_port_closes(self):
        for end in (
            bpy.ops.mien_face.stop,
            stage.empty_scene,
            lambda: bpy.ops.wm.read_factory_settings(use_empty=True),
        ):
            self.scene = bpy.context.scene
            if not hasattr(bpy.types.Scene, "mien_face"):
                bpy.ops.preferences.addon_enable(module=stage.ADD_ON)
                self.live = stage.module("live")
            self.start("jawOpen")
            self.assertFalse(self.port_is_free())
            end()
            self.assertTrue(self.port_is_free())
        if not hasattr(bpy.types.Scene, "mien_face"):
            bpy.ops.preferences.addon_enable(module=stage.ADD_ON)

    def test_disabling_closes_the_port(self):
        self.start("jawOpen")
        bpy.ops.preferences.addon_disable(module=stage.ADD_ON)
        self.assertTrue(self.port_is_free())
        self.assertFalse(hasattr(bpy.types.Scene, "mien_face"))
        bpy.ops.preferences.addon_enable(module=stage.ADD_ON)

    def test_a_deleted_scene_ends_the_session(self):
        self.start("jawOpen")
        bpy.ops.scene.new(type="EMPTY")
        bpy.data.scenes.remove(self.scene)
        self.assertIsNone(self.live.tick())
        self.assertTrue(self.port_is_free())
        self.assertEqual(self.live.status(), [("Stopped: the scene was deleted", True)])

    def test_a_port_in_use(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", self.port))
            self.assert_fails(f"port: cannot listen on 127.0.0.1:{self.port}", lambda: self.start("jawOpen"))
        self.assertFalse(self.live.running())

    def test_an_empty_recording(self):
        self.start("jawOpen")
        bpy.ops.mien_face.record()
        self.assert_fails("no frames arrived", bpy.ops.mien_face.finish_recording)
        self.assertTrue(self.live.running())


if __name__ == "__main__":
    result = unittest.main(verbosity=2, exit=False).result
    RESOURCES.cleanup()
    sys.stderr.flush()
    os._exit(
        not result.wasSuccessful()
    )  # Blender 4.2's module crashes when Python exits after any class was registered
