"""Tests the avatar in the program's GLB in Blender's Python module.

usage: program_avatar_test.py MIEN_PROGRAM SOURCE_FOLDER      in an environment with bpy
"""

import csv
import os
import subprocess
import sys
import tempfile
import unittest

import blender_scene as stage
import bpy

PROGRAM, SOURCE = sys.argv[1:3]
del sys.argv[1:3]


class ProgramAvatar(unittest.TestCase):
    def test_shape_keys_have_the_values_of_the_csv(self):
        with tempfile.TemporaryDirectory() as folder:
            glb, curves = (os.path.join(folder, name) for name in ("demo.glb", "demo.csv"))
            clip = SOURCE + "/tests/data/demo.mp4"
            subprocess.run(
                [PROGRAM, "track", clip, "--models", SOURCE + "/models", "--quiet", "-o", glb, "-o", curves],
                check=True,
                timeout=300,
            )
            with open(curves) as file:
                table = list(csv.DictReader(file))
            scene = stage.empty_scene()
            bpy.ops.import_scene.gltf(filepath=glb)
        keys = bpy.data.objects["face"].data.shape_keys.key_blocks
        self.assertEqual(len(keys), 1 + 52)
        opened, still = keys["jawOpen"].data, keys[0].data
        self.assertGreater(max((moved.co - base.co).length for moved, base in zip(opened, still)), 0.02)
        fps = scene.render.fps / scene.render.fps_base
        for row in table[::25]:
            frame = fps * (float(row["t_ms"]) - float(table[0]["t_ms"])) / 1000
            scene.frame_set(int(frame), subframe=frame - int(frame))
            for key in keys[1:]:
                self.assertAlmostEqual(key.value, float(row[key.name] or 0), delta=2e-3, msg=f"{key.name} at {frame}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
