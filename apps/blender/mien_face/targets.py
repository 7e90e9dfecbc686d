"""The chosen shape keys and head, and how a frame moves them."""

from dataclasses import dataclass

import bpy
from mathutils import Euler, Quaternion

from .conversion import values_in
from .frame import FaceDataError
from .rotation import of_bone, scaled, to_space
from .shape_names import match


@dataclass
class ShapeKeys:
    """The shape keys of a mesh that have a control: {name of key: (vocabulary, name)}."""

    mesh_name: str
    keys: bpy.types.Key
    matches: dict


def shape_keys(settings):
    """One entry per mesh, even if several objects share it. Deleted meshes and those without shape keys are ignored."""
    found = {}
    for item in settings.meshes:
        keys = item.object.data.shape_keys if item.object and item.object.type == "MESH" else None
        if keys and keys.session_uid not in found:
            names = tuple(block.name for block in keys.key_blocks if block != keys.reference_key)
            matches = match(names, settings.vocabulary, settings.prefix, settings.suffix)
            found[keys.session_uid] = ShapeKeys(item.object.name, keys, matches)
    return list(found.values())


class Head:
    """A bone, or an object, which then rotates by its delta rotation, so that its own rotation remains."""

    def __init__(self, settings):
        self.object, self.settings = settings.head_object, settings
        self.bone = self._bone() if self.object.type == "ARMATURE" else None
        self.owner = self.bone or self.object
        self.mode = self.owner.rotation_mode
        if self.bone is None and self.mode == "AXIS_ANGLE":
            raise FaceDataError(f"head: {self.object.name} rotates by axis and angle, expected quaternion or Euler")
        self.rest = tuple(self.bone.bone.matrix_local.to_quaternion()) if self.bone else None

    def _bone(self):
        bone = self.object.pose.bones.get(self.settings.head_bone)
        if bone is None:
            raise FaceDataError(f"head: {self.object.name} has no bone '{self.settings.head_bone}'")
        return bone

    @property
    def channel(self):
        kind = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}.get(
            self.mode, "rotation_euler"
        )
        return kind if self.bone else f"delta_{kind}"

    @property
    def data_path(self):
        if self.bone is None:
            return self.channel
        return f'pose.bones["{bpy.utils.escape_identifier(self.bone.name)}"].{self.channel}'

    def rotation(self, q, previous=None):
        """The value of the property for a head at q in mien's axes; Euler angles without a jump from `previous`."""
        turned = to_space(scaled(q, self.settings.head_scale), self.settings.front)
        turned = Quaternion(of_bone(turned, self.rest) if self.bone else turned)
        if self.mode == "QUATERNION":
            return tuple(turned)
        if self.mode == "AXIS_ANGLE":
            axis, angle = turned.to_axis_angle()
            return (angle, *axis)
        return tuple(turned.to_euler(self.mode, Euler(previous or (0.0, 0.0, 0.0), self.mode)))

    def apply(self, q):
        setattr(self.owner, self.channel, self.rotation(q))


def head(settings):
    """None if no head is chosen. Raises FaceDataError if the chosen one cannot rotate."""
    return Head(settings) if settings.use_head and settings.head_object else None


def apply(settings, frame):
    """Moves the chosen shape keys and the head to a frame. Those without a value in the frame stay."""
    values = {}
    for shapes in shape_keys(settings):
        for key, (vocabulary, name) in shapes.matches.items():
            if vocabulary not in values:
                values[vocabulary] = values_in(vocabulary, frame)
            value = values[vocabulary].get(name)
            if value is not None:
                shapes.keys.key_blocks[key].value = value * settings.control_scale
    turning = head(settings)
    if turning and frame.head:
        turning.apply(frame.head)


def add_meshes(settings, objects):
    """Adds meshes with shape keys, and their armature's head if none is chosen yet. Returns how many are new."""
    known = {item.object for item in settings.meshes}
    new = [o for o in objects if o.type == "MESH" and o.data.shape_keys and o not in known]
    for mesh in new:
        settings.meshes.add().object = mesh
        armature = mesh.find_armature() or (mesh.parent if mesh.parent and mesh.parent.type == "ARMATURE" else None)
        if armature and settings.head_object is None:
            find_head(settings, armature)
    return len(new)


def find_head(settings, armature):
    """Chooses the bone named head, in any case and after a separator: Head, rig:Head, J_Bip_C_Head."""
    names = [bone.name for bone in armature.data.bones]
    named = [name for name in names if name.lower() == "head"] or [
        name for name in names if name.lower().endswith(("_head", ":head", ".head"))
    ]
    if named:
        settings.head_object, settings.head_bone = armature, named[0]
