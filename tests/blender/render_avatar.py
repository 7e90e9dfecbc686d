"""Renders the avatar at frames of a CSV that the add-on imports, for people to look at: a row of images.

usage: render_avatar.py ZIP AVATAR_GLB CSV OUTPUT.png FRAME...      in an environment with bpy; 24 frames per second
"""

import os
import sys
import tempfile

RESOURCES = tempfile.TemporaryDirectory()
os.environ["BLENDER_USER_RESOURCES"] = RESOURCES.name

import bpy  # noqa: E402
import numpy  # noqa: E402
from blender_scene import choose, empty_scene, install, load_avatar  # noqa: E402

SIDE = 256


def stage(scene, mesh):
    scene.render.engine, scene.cycles.samples = "CYCLES", 8
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler, camera.data.lens = (0.0, -9.0, -0.1), (1.5708, 0.0, 0.0), 110.0
    light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "SUN"))
    light.data.energy, light.rotation_euler = 3.0, (0.8, -0.3, 0.0)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    for item in (camera, light):
        scene.collection.objects.link(item)
    scene.camera = camera
    material = bpy.data.materials.new("Colours")
    material.use_nodes = True
    attribute = material.node_tree.nodes.new("ShaderNodeVertexColor")
    attribute.layer_name = mesh.data.color_attributes[0].name
    material.node_tree.links.new(
        attribute.outputs["Color"], material.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    )
    mesh.data.materials.clear()
    mesh.data.materials.append(material)
    mesh.data.shade_smooth()


def picture(scene, frame):
    scene.frame_set(frame)
    scene.render.filepath = os.path.join(RESOURCES.name, f"{frame}.png")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    return numpy.array(image.pixels[:]).reshape(SIDE, SIDE, 4)


def main(archive, glb, csv_file, output, *frames):
    install(archive)
    scene = empty_scene()
    mesh, armature = load_avatar(glb)
    armature.rotation_euler.z = 0.0
    choose(scene, mesh)
    bpy.ops.mien_face.import_csv(filepath=csv_file)
    stage(scene, mesh)
    row = numpy.concatenate([picture(scene, int(frame)) for frame in frames], axis=1)
    image = bpy.data.images.new("Row", row.shape[1], SIDE)
    image.pixels = row.ravel()
    image.filepath_raw, image.file_format = output, "PNG"
    image.save()


main(*sys.argv[1:])
sys.stdout.flush()
os._exit(0)  # Blender 4.2's module crashes when Python exits after any class was registered
