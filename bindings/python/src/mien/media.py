"""Whole files: what ffmpeg can read goes in, a row for each frame comes out."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Iterable, Iterator, Union

import numpy as np
import numpy.typing as npt

from ._ffmpeg import SOUND_RATE, pictures, samples, streams
from .errors import MienError
from .result import Result
from .tracker import Lod, Tracker
from .vocabulary import CONTROL_NAMES

Row = dict[str, Union[int, float, str]]

_SOUND_AHEAD_S = 0.1  # a frame takes sound that ends 42 ms after it
_FRAMES_A_SECOND = 30.0  # of sound without pictures


def track_file(path: Union[str, Path], *, lod: Lod = 4, sound: bool = True, smoothing: bool = True) -> Iterator[Row]:
    """A row for every frame of a film, picture and sound together; of a file without pictures 30 a second.

    A row has time_s, status, face_id, face_probability, voice_activity, x, y, width, height (the face's box), pitch, yaw, roll,
    tx, ty, tz, and the 52 controls by name. Needs ffmpeg and ffprobe, which comes with it. The file is read while the rows are taken:
    one that is damaged or ends early is a MienError after its last good row.
    """
    for program in ("ffmpeg", "ffprobe"):
        if shutil.which(program) is None:
            raise MienError(f"{program} is not installed, which reads the file")
    if not Path(path).is_file():
        raise FileNotFoundError(f"no file {str(path)!r}")
    return _rows(Path(path), lod, sound, smoothing)


def columns(rows: Iterable[Row]) -> dict[str, npt.NDArray[np.generic]]:
    """Rows as one array for each name: pandas.DataFrame(mien.columns(mien.track_file(path)))."""
    taken = list(rows)
    return {name: np.array([row[name] for row in taken]) for name in (taken[0] if taken else {})}


def _rows(path: Path, lod: Lod, sound: bool, smoothing: bool) -> Iterator[Row]:
    film, has_sound = streams(path)
    voice = samples(path) if sound and has_sound else np.empty(0, np.float32)
    if film is None and voice.size == 0:
        raise MienError(f"{path} has no pictures, and no sound that was asked for")
    heard = 0
    with Tracker(lod, sound=voice.size > 0, smoothing=smoothing) as tracker:

        def hear(until_s: float) -> None:
            nonlocal heard
            end = min(int(until_s * SOUND_RATE), voice.size)
            if end > heard:
                tracker.push_audio(voice[heard:end], heard / SOUND_RATE, SOUND_RATE)
                heard = end

        if film is not None:
            for frame, time_s in pictures(path, film):
                hear(time_s + _SOUND_AHEAD_S)
                yield _row(tracker.track(frame, time_s, color="i420", full_range=False))
            return
        for i in range(int(voice.size / SOUND_RATE * _FRAMES_A_SECOND)):
            time_s = i / _FRAMES_A_SECOND
            hear(time_s + _SOUND_AHEAD_S)
            yield _row(tracker.advance(time_s))


def _row(result: Result) -> Row:
    x, y, width, height = (float(v) for v in result.box)
    pose = result.pose
    tx, ty, tz = (float(v) for v in pose.translation)
    row: Row = {
        "time_s": result.time_s,
        "status": result.status.name.lower(),
        "face_id": result.face_id,
        "face_probability": result.face_probability,
        "voice_activity": result.voice_activity,
        "x": x,
        "y": y,
        "width": width,
        "height": height,
        "pitch": pose.pitch,
        "yaw": pose.yaw,
        "roll": pose.roll,
        "tx": tx,
        "ty": ty,
        "tz": tz,
    }
    row.update(zip(CONTROL_NAMES, result.controls.array.tolist()))
    return row
