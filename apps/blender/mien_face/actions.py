"""Writes curves into actions of any version of Blender."""

from dataclasses import dataclass

import bpy

from . import targets
from .curves import control_curves, head_curve
from .frame import FaceDataError

_LAST_FRAME = 1048574  # Blender's
_CONSTANT, _LINEAR = 0, 1  # of Keyframe.interpolation


@dataclass
class Written:
    """Objects that an import or a recording has created."""

    shape_curves: int = 0
    head_name: str = ""
    first: float = float("inf")
    last: float = float("-inf")

    def see(self, times):
        self.first, self.last = min(self.first, times[0]), max(self.last, times[-1])

    def summary(self):
        head = f", head on {self.head_name}" if self.head_name else ""
        return f"{self.shape_curves} shape keys{head}, frames {self.first:.2f} to {self.last:.2f}"


def _fcurves(owner, name, merge):
    """Curves of the owner's action: of a new one with this name, or with `merge` of the present one, if any."""
    data = owner.animation_data or owner.animation_data_create()
    old = data.action
    if not (merge and old):
        if old:
            old.use_fake_user = True  # so that it is saved, although nothing uses it any more
        data.action = bpy.data.actions.new(name)
    action = data.action
    if not hasattr(action, "slots"):  # before Blender 4.4
        return action.fcurves
    slot = data.action_slot or action.slots.new(owner.id_type, owner.name)
    data.action_slot = slot
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True).fcurves


def _write(fcurves, data_path, index, curve, values):
    existing = fcurves.find(data_path, index=index)
    if existing:
        fcurves.remove(existing)
    points = fcurves.new(data_path, index=index)
    keys = points.keyframe_points
    keys.add(len(curve.times))
    keys.foreach_set("co", [part for key in zip(curve.times, values) for part in key])
    keys.foreach_set("interpolation", [_CONSTANT if hold else _LINEAR for hold in curve.holds])
    points.update()


def _check_times(frames, time_of):
    for frame in (frames[0], frames[-1]):
        if abs(time_of(frame.time_s)) > _LAST_FRAME:
            number = f"{time_of(frame.time_s):.0f}"
            raise FaceDataError(f"time: frame {number} is beyond Blender's last, {_LAST_FRAME}; start at the first row")


def _write_shapes(shapes, curves, scale, name, merge, written):
    keys = {key: curves[control] for key, control in shapes.matches.items() if control in curves}
    if not keys:
        return
    fcurves = _fcurves(shapes.keys, f"{name} {shapes.mesh_name}", merge)
    for key, curve in keys.items():
        path = f'key_blocks["{bpy.utils.escape_identifier(key)}"].value'
        _write(fcurves, path, 0, curve, [scale * value for value in curve.values])
        written.see(curve.times)
    written.shape_curves += len(keys)


def _write_head(head, curve, name, merge, written):
    fcurves = _fcurves(head.object, f"{name} {head.object.name}", merge)
    rows, previous = [], None
    for q in curve.values:
        rows.append(head.rotation(q, previous))
        previous = rows[-1]
    for index, values in enumerate(zip(*rows)):
        _write(fcurves, head.data_path, index, curve, values)
    written.see(curve.times)
    written.head_name = f"{head.object.name}: {head.bone.name}" if head.bone else head.object.name


def write(settings, frames, time_of, name, merge):
    """Animates the chosen shape keys and the head. Raises FaceDataError, with no change, if there is nothing to do."""
    shapes, head = targets.shape_keys(settings), targets.head(settings)
    curves = control_curves(frames, time_of, {control for item in shapes for control in item.matches.values()})
    turning = head_curve(frames, time_of) if head else None
    if not curves and not (turning and turning.times):
        raise FaceDataError(
            "no shape key of the chosen meshes has a name whose control is in the data, and no head is chosen"
        )
    _check_times(frames, time_of)
    written = Written()
    for item in shapes:
        _write_shapes(item, curves, settings.control_scale, name, merge, written)
    if turning and turning.times:
        _write_head(head, turning, name, merge, written)
    return written
