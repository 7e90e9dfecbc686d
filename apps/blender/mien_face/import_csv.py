"""File > Import > mien CSV / Live Link Face CSV."""

import os

import bpy
from bpy_extras.io_utils import ImportHelper

from . import actions, panel, targets
from .clip import ReadOptions, read_clip
from .frame import FaceDataError
from .settings import ROTATION_ITEMS

_ORIGIN_ITEMS = [
    (
        "recording",
        "The recording's start",
        "Time 0 of mien's files, so that the animation stays in sync with the recording; "
        "the first row of Live Link Face",
    ),
    ("first", "The first row", ""),
]
_ACTION_ITEMS = [
    ("new", "Replace", "Create new actions; the present ones get a fake user, so that they remain in the file"),
    ("merge", "Keep", "Write into the present actions and replace only the curves of the same properties"),
]


class MIEN_FACE_OT_import_csv(bpy.types.Operator, ImportHelper):
    bl_idname = "mien_face.import_csv"
    bl_label = "Import Face CSV"
    bl_description = "Animate the chosen meshes and head with a file of mien or Live Link Face"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    filename_ext = ".csv"
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})
    start_frame: bpy.props.FloatProperty(
        name="Start frame", default=1.0, description="Frame of the scene at which the animation starts"
    )
    origin: bpy.props.EnumProperty(
        name="Starts with", items=_ORIGIN_ITEMS, description="Time that comes to the start frame"
    )
    action: bpy.props.EnumProperty(name="Present actions", items=_ACTION_ITEMS)
    face: bpy.props.IntProperty(
        name="Face", min=0, description="Id of the face, if mien tracked several; 0: the one in most rows"
    )
    llf_fps: bpy.props.FloatProperty(
        name="Timecode", min=0.0, max=100.0, description="Frames per second of Live Link Face's timecode; 0: detected"
    )
    llf_rotation: bpy.props.EnumProperty(
        name="Angles",
        items=[("auto", "Detected", ""), *ROTATION_ITEMS],
        description="Unit of Live Link Face's rotations",
    )

    def invoke(self, context, event):
        self.start_frame = context.scene.frame_start
        return ImportHelper.invoke(self, context, event)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("start_frame", "origin", "action", "face", "llf_fps", "llf_rotation"):
            layout.prop(self, name)
        panel.draw_mapping(layout.column(), context.scene.mien_face)

    def execute(self, context):
        try:
            written, notes = self.animate(context)
        except FaceDataError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Imported {'; '.join([written.summary(), *notes])}")
        return {"FINISHED"}

    def animate(self, context):
        scene, settings = context.scene, context.scene.mien_face
        clip = read_clip(self.filepath, ReadOptions(self.face, self.llf_fps, self.llf_rotation))
        if not settings.meshes:
            targets.add_meshes(settings, context.selected_objects)
        start_s = clip.frames[0].time_s if self.origin == "first" else clip.start_s
        per_second = scene.render.fps / scene.render.fps_base
        name = os.path.splitext(os.path.basename(self.filepath))[0]
        written = actions.write(
            settings, clip.frames, lambda t: self.start_frame + (t - start_s) * per_second, name, self.action == "merge"
        )
        return written, clip.notes


def _draw_entry(self, _):
    self.layout.operator(MIEN_FACE_OT_import_csv.bl_idname, text="mien CSV / Live Link Face CSV (.csv)")


CLASSES = (MIEN_FACE_OT_import_csv,)


def register():
    bpy.types.TOPBAR_MT_file_import.append(_draw_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_draw_entry)
