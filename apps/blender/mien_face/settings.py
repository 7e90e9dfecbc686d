"""What the user chooses, stored in the scene."""

import bpy

from .conversion import VOCABULARIES

_LABELS = {
    "arkit": "ARKit, MediaPipe",
    "roblox": "Roblox",
    "visemes": "Visemes (Oculus, Ready Player Me)",
    "vrm1": "VRM 1",
    "vrm0": "VRM 0",
}
_NAME_ITEMS = [
    ("auto", "Automatic", "The vocabulary with most matches"),
    *((name, _LABELS[name], "") for name in VOCABULARIES),
]
_FRONT_ITEMS = [
    ("-Y", "-Y", "As in Blender's front view; glTF, VRM"),
    ("Y", "Y", ""),
    ("X", "X", ""),
    ("-X", "-X", ""),
    ("Z", "Z, with Y up", "Space of an armature that an FBX importer turned by its object"),
]
ROTATION_ITEMS = [
    ("rad", "Radians", "Live Link Face, mien"),
    ("norm180", "Degrees / 180", "Unreal's own sender"),
    ("deg", "Degrees", ""),
]


def has_shape_keys(_, candidate):
    return candidate.type == "MESH" and candidate.data.shape_keys is not None


class MienFaceMesh(bpy.types.PropertyGroup):
    object: bpy.props.PointerProperty(name="Mesh", type=bpy.types.Object, poll=has_shape_keys)


class MienFaceSettings(bpy.types.PropertyGroup):
    meshes: bpy.props.CollectionProperty(type=MienFaceMesh)
    active_mesh: bpy.props.IntProperty(name="Active mesh")
    vocabulary: bpy.props.EnumProperty(name="Names", items=_NAME_ITEMS, description="Vocabulary of the shape keys")
    prefix: bpy.props.StringProperty(name="Prefix", description="Before the names of the shape keys; empty: detected")
    suffix: bpy.props.StringProperty(name="Suffix", description="After the names of the shape keys; empty: detected")
    control_scale: bpy.props.FloatProperty(
        name="Scale", default=1.0, min=0.0, max=4.0, description="Factor on shape keys, which stay in their range"
    )
    use_head: bpy.props.BoolProperty(name="Head", default=True, description="Rotate the head")
    head_object: bpy.props.PointerProperty(
        name="Object", type=bpy.types.Object, description="Armature, or an object that is the head"
    )
    head_bone: bpy.props.StringProperty(name="Bone", description="Bone of the armature that rotates with the head")
    head_scale: bpy.props.FloatProperty(
        name="Scale", default=1.0, min=0.0, max=4.0, description="Factor on the angle of the head"
    )
    front: bpy.props.EnumProperty(
        name="Faces", items=_FRONT_ITEMS, description="Where the character looks in the space of its armature"
    )
    port: bpy.props.IntProperty(name="Port", default=11111, min=1, max=65535, description="UDP port to receive on")
    from_network: bpy.props.BoolProperty(
        name="Other machines", description="Receive from the network; off: from programs on this machine only"
    )
    llf_rotation: bpy.props.EnumProperty(
        name="Angles", items=ROTATION_ITEMS, description="Unit of rotations in packets of Live Link Face"
    )


CLASSES = (MienFaceMesh, MienFaceSettings)


def register():
    bpy.types.Scene.mien_face = bpy.props.PointerProperty(type=MienFaceSettings)


def unregister():
    del bpy.types.Scene.mien_face
