"""The tab "mien" in the sidebar of the 3D view."""

import bpy

from . import live, targets
from .frame import FaceDataError


class MIEN_FACE_UL_meshes(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property):
        layout.prop(item, "object", text="", emboss=False, icon="MESH_DATA")


def draw_mapping(layout, settings):
    """Scales and axes, for received and imported frames."""
    layout.prop(settings, "control_scale", text="Shape keys")
    layout.prop(settings, "use_head")
    column = layout.column()
    column.enabled = settings.use_head
    column.prop(settings, "head_scale", text="Head angle")
    column.prop(settings, "front")


def _draw_matches(layout, settings):
    for shapes in targets.shape_keys(settings):
        names = sorted({vocabulary for vocabulary, _ in shapes.matches.values()})
        count = f"{len(shapes.matches)} of {len(shapes.keys.key_blocks) - 1}"
        text = f"{shapes.mesh_name}: {count} ({', '.join(names) or 'no name known'})"
        layout.label(text=text, icon="CHECKMARK" if shapes.matches else "ERROR")


def _draw_meshes(layout, settings):
    row = layout.row()
    row.template_list("MIEN_FACE_UL_meshes", "", settings, "meshes", settings, "active_mesh", rows=2)
    buttons = row.column(align=True)
    buttons.operator("mien_face.add_meshes", text="", icon="ADD")
    buttons.operator("mien_face.remove_mesh", text="", icon="REMOVE")
    column = layout.column()
    for name in ("vocabulary", "prefix", "suffix"):
        column.prop(settings, name)
    _draw_matches(layout, settings)


def _draw_head(layout, settings):
    layout.prop(settings, "head_object", text="Head")
    if settings.head_object and settings.head_object.type == "ARMATURE":
        layout.prop_search(settings, "head_bone", settings.head_object.data, "bones")
    try:
        targets.head(settings)
    except FaceDataError as error:
        layout.label(text=str(error), icon="ERROR")


def _draw_live(layout, settings):
    column = layout.column()
    column.enabled = not live.running()
    for name in ("port", "from_network", "llf_rotation"):
        column.prop(settings, name)
    row = layout.row(align=True)
    if live.running():
        row.operator("mien_face.stop", text="Stop", icon="PAUSE")
        if live.recording():
            row.operator("mien_face.finish_recording", text="Finish", icon="CHECKMARK")
        else:
            row.operator("mien_face.record", icon="REC")
    else:
        row.operator("mien_face.start", icon="PLAY")
    for text, problem in live.status():
        layout.label(text=text, icon="ERROR" if problem else "INFO")


class MIEN_FACE_PT_sidebar(bpy.types.Panel):
    bl_label = "mien"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "mien"

    def draw(self, context):
        layout, settings = self.layout, context.scene.mien_face
        layout.use_property_split = True
        layout.use_property_decorate = False
        _draw_meshes(layout, settings)
        _draw_head(layout, settings)
        draw_mapping(layout, settings)
        layout.separator()
        _draw_live(layout, settings)
        layout.operator("mien_face.import_csv", icon="IMPORT")


CLASSES = (MIEN_FACE_UL_meshes, MIEN_FACE_PT_sidebar)
