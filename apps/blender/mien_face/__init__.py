"""Facial animation in Blender: live on shape keys and a head, or imported from files as actions."""

try:
    import bpy
except ModuleNotFoundError:  # the modules without Blender, in tests
    bpy = None

if bpy is not None:
    from . import import_csv, live, operators, panel, settings

    _CLASSES = (*settings.CLASSES, *operators.CLASSES, *import_csv.CLASSES, *panel.CLASSES)
    _PARTS = (settings, live, import_csv)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    for part in _PARTS:
        part.register()


def unregister():
    for part in reversed(_PARTS):
        part.unregister()
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
