"""Reads animation files: CSV of mien and of Live Link Face."""

import os
from dataclasses import dataclass, field

from . import live_link_csv, mien_csv
from .csv_table import MAX_BYTES, Table, decoded
from .frame import FaceDataError


@dataclass
class Clip:
    """Frames in order of time; `notes` are for the user. The recording begins at `start_s`."""

    frames: list
    notes: list = field(default_factory=list)
    start_s: float = 0.0


@dataclass
class ReadOptions:
    face_id: int = 0  # of mien's CSV; 0: the face in most rows
    llf_fps: float = 0.0  # of Live Link Face's timecode; 0: from FILE.json, or detected
    llf_rotation: str = "auto"  # its unit of rotations: auto, rad, norm180, deg


def _data(path):
    try:
        if os.path.getsize(path) > MAX_BYTES:
            raise FaceDataError(f"larger than {MAX_BYTES >> 20} MiB")
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise FaceDataError(error.strerror or str(error)) from None


def _clip(path, options):
    text = decoded(_data(path))
    table = Table(text)
    if table.has("t_ms"):
        return Clip(*mien_csv.read(table, options.face_id))
    if table.has("Timecode"):
        unit, fps = live_link_csv.units(text, options, path + ".json")
        frames, notes = live_link_csv.read(table, unit, fps)
        return Clip(frames, notes, frames[0].time_s)
    raise FaceDataError("line 1: neither CSV of mien (column t_ms) nor of Live Link Face (column Timecode)")


def read_clip(path, options):
    """Raises FaceDataError, whose message names the file and the line."""
    try:
        return _clip(path, options)
    except FaceDataError as error:
        raise FaceDataError(f"{os.path.basename(path)}: {error}") from None
