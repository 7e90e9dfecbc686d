"""Buttons of the panel."""

import bpy

from . import live, targets
from .frame import FaceDataError


class MIEN_FACE_OT_add_meshes(bpy.types.Operator):
    bl_idname = "mien_face.add_meshes"
    bl_label = "Add Selected Meshes"
    bl_description = "Add the selected meshes that have shape keys"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        if not targets.add_meshes(context.scene.mien_face, context.selected_objects):
            self.report({"WARNING"}, "No further mesh with shape keys is selected")
            return {"CANCELLED"}
        return {"FINISHED"}


class MIEN_FACE_OT_remove_mesh(bpy.types.Operator):
    bl_idname = "mien_face.remove_mesh"
    bl_label = "Remove Mesh"
    bl_description = "Remove the mesh from the list; the mesh itself stays"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return len(context.scene.mien_face.meshes) > 0

    def execute(self, context):
        settings = context.scene.mien_face
        settings.meshes.remove(settings.active_mesh)
        settings.active_mesh = max(0, min(settings.active_mesh, len(settings.meshes) - 1))
        return {"FINISHED"}


class MIEN_FACE_OT_start(bpy.types.Operator):
    bl_idname = "mien_face.start"
    bl_label = "Start Receiving"
    bl_description = "Receive from `mien live --send jsonl://:PORT`, or from Live Link Face"

    @classmethod
    def poll(cls, _):
        return not live.running()

    def execute(self, context):
        try:
            live.start(context.scene)
        except FaceDataError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class MIEN_FACE_OT_stop(bpy.types.Operator):
    bl_idname = "mien_face.stop"
    bl_label = "Stop Receiving"
    bl_description = "Close the port; a recording is discarded"

    @classmethod
    def poll(cls, _):
        return live.running()

    def execute(self, _):
        live.stop()
        return {"FINISHED"}


class MIEN_FACE_OT_record(bpy.types.Operator):
    bl_idname = "mien_face.record"
    bl_label = "Record"
    bl_description = "Record received animation from the current frame on"

    @classmethod
    def poll(cls, _):
        return live.running() and not live.recording()

    def execute(self, context):
        live.start_recording(context.scene)
        return {"FINISHED"}


class MIEN_FACE_OT_finish_recording(bpy.types.Operator):
    bl_idname = "mien_face.finish_recording"
    bl_label = "Finish Recording"
    bl_description = "Write the recording as actions"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, _):
        return live.recording()

    def execute(self, context):
        try:
            written = live.stop_recording(context.scene)
        except FaceDataError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Recorded {written.summary()}")
        return {"FINISHED"}


CLASSES = (
    MIEN_FACE_OT_add_meshes,
    MIEN_FACE_OT_remove_mesh,
    MIEN_FACE_OT_start,
    MIEN_FACE_OT_stop,
    MIEN_FACE_OT_record,
    MIEN_FACE_OT_finish_recording,
)
