"""Reads mien's CSV: controls of ARKit, Roblox's units, or visemes."""

import math
from collections import Counter

from .csv_table import quoted
from .frame import Frame
from .rotation import of_angles
from .vocabularies import ARKIT, ROBLOX, VISEMES

_ANGLES = ("pitch_rad", "yaw_rad", "roll_rad")
_NAMES = {"arkit": ARKIT, "roblox": tuple(ROBLOX), "visemes": VISEMES}


def _time(table):
    t_ms = table.number("t_ms")
    if t_ms is None:
        raise table.error("t_ms: empty")
    return t_ms / 1000.0


def _fraction(table, name):
    value = table.number(name)
    if value is not None and not 0.0 <= value <= 1.0:
        raise table.error(f"{name}: {quoted(table.text(name))} is not in 0..1")
    return value


def _head(table):
    angles = table.all_numbers(_ANGLES)
    if angles is None:
        return None
    for name, angle in zip(_ANGLES, angles):
        if abs(angle) > 2.0 * math.pi:
            raise table.error(f"{name}: more than a full turn (got {angle:g}); angles are in radians")
    return of_angles(*angles)


def _face_id(table):
    text = table.text("face_id") or "0"
    if not text.isascii() or not text.isdigit():
        raise table.error(f"face_id: {quoted(text)} is not a number of a face")
    return int(text[:9])


def _frame(table, vocabulary, names):
    table.check_width()
    values = {name: _fraction(table, name) for name in names}
    return Frame(
        _time(table), {vocabulary: {name: value for name, value in values.items() if value is not None}}, _head(table)
    )


def read(table, face_id):
    """Frames of a face, and notes. Face 0 is the one in most rows."""
    columns = {vocabulary: [name for name in names if table.has(name)] for vocabulary, names in _NAMES.items()}
    vocabulary = max(columns, key=lambda name: len(columns[name]))
    if not columns[vocabulary]:
        raise table.error("no column with a control (eyeBlinkLeft ... tongueOut), a Roblox unit or a viseme")
    faces, last_s = {}, -math.inf
    while table.next_row():
        frame = _frame(table, vocabulary, columns[vocabulary])
        if frame.time_s < last_s:
            raise table.error("t_ms: decreasing time")
        last_s = frame.time_s
        faces.setdefault(_face_id(table), []).append(frame)
    return _of_face(table, faces, face_id)


def _of_face(table, faces, face_id):
    if not faces:
        raise table.error("no frames")
    tracked = Counter({face: len(frames) for face, frames in faces.items() if face})
    chosen = face_id or max(tracked or faces, key=lambda face: len(faces[face]))
    if chosen not in faces:
        raise table.error(f"face: no row has face_id {face_id} (got {', '.join(map(str, sorted(faces)))})")
    notes = [f"face {chosen} of {len(tracked)}"] if len(tracked) > 1 else []
    return faces[chosen], notes
