"""Blender with the add-on installed, and the avatar with a bone for its head.

Set BLENDER_USER_RESOURCES to an empty folder before.
"""

import importlib
import math

import bpy

ADD_ON = "bl_ext.user_default.mien_face"
HEAD_REST = (0.4, -0.3, 1.1)  # direction and roll of the bone are not those of the world, as in most rigs


def install(archive):
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    assert ADD_ON in bpy.context.preferences.addons


def module(name):
    return importlib.import_module(f"{ADD_ON}.{name}")


def empty_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    return bpy.context.scene


def head_armature():
    """An armature with the bones Neck and Head, below each other, in an object that is turned in the scene."""
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    neck, head = (armature.data.edit_bones.new(name) for name in ("Neck", "Head"))
    neck.head, neck.tail = (0, 0.2, -1.5), (0, 0.1, -0.6)
    head.head, head.tail, head.roll = neck.tail, HEAD_REST, 0.7
    head.parent = neck
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.rotation_euler.z = math.radians(25.0)
    return armature


def load_avatar(glb):
    """(mesh object, armature): the avatar as a user would import it, on the bone."""
    bpy.ops.import_scene.gltf(filepath=glb)
    mesh = bpy.data.objects["Avatar"]
    armature = head_armature()
    mesh.vertex_groups.new(name="Head").add(range(len(mesh.data.vertices)), 1.0, "REPLACE")
    mesh.parent = armature
    mesh.modifiers.new("Armature", "ARMATURE").object = armature
    return mesh, armature


def choose(scene, *objects):
    """Selects the objects and adds them as a user would."""
    for candidate in scene.objects:
        candidate.select_set(candidate in objects)
    bpy.ops.mien_face.add_meshes()
    return scene.mien_face


def fcurves(owner):
    """{(data path, index): curve} of the owner's action."""
    data = owner.animation_data
    if not data or not data.action:
        return {}
    if hasattr(data.action, "layers"):
        found = [
            c
            for bag in data.action.layers[0].strips[0].channelbags
            if bag.slot == data.action_slot
            for c in bag.fcurves
        ]
    else:
        found = data.action.fcurves
    return {(curve.data_path, curve.array_index): curve for curve in found}


def keys(curve):
    """[(frame, value)]"""
    flat = [0.0] * 2 * len(curve.keyframe_points)
    curve.keyframe_points.foreach_get("co", flat)
    return list(zip(flat[::2], flat[1::2]))


def vertices(mesh_object):
    """World positions as they are displayed now."""
    shown = mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [shown.matrix_world @ vertex.co for vertex in shown.data.vertices]
