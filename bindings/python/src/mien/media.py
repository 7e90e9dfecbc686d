"""Whole files: what ffmpeg can read goes in, a row for each frame comes out."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import IO, Iterable, Iterator, Union

import numpy as np
import numpy.typing as npt

from .errors import MienError
from .result import Result
from .tracker import Lod, Tracker
from .vocabulary import CONTROL_NAMES

Row = dict[str, Union[int, float, str]]

_SOUND_RATE = 16000
_SOUND_AHEAD_S = 0.1  # a frame takes sound that ends 42 ms after it
_FRAMES_A_SECOND = 30.0  # of sound without pictures


def track_file(path: Union[str, Path], *, lod: Lod = 4, sound: bool = True, smoothing: bool = True) -> Iterator[Row]:
    """A row for every frame of a film, picture and sound together; of a file without pictures 30 a second.

    A row has time_s, status, face_id, face_probability, voice_activity, x, y, width, height (the face's box), pitch, yaw, roll,
    tx, ty, tz, and the 52 controls by name. Needs ffmpeg. The file is read while the rows are taken.
    """
    if shutil.which("ffmpeg") is None:
        raise MienError("ffmpeg is not installed, which reads the file")
    if not Path(path).is_file():
        raise FileNotFoundError(f"no file {str(path)!r}")
    return _rows(Path(path), lod, sound, smoothing)


def columns(rows: Iterable[Row]) -> dict[str, npt.NDArray[np.generic]]:
    """Rows as one array for each name: pandas.DataFrame(mien.columns(mien.track_file(path)))."""
    taken = list(rows)
    return {name: np.array([row[name] for row in taken]) for name in (taken[0] if taken else {})}


def _rows(path: Path, lod: Lod, sound: bool, smoothing: bool) -> Iterator[Row]:
    voice = _samples(path) if sound else np.empty(0, np.float32)
    heard = 0
    with Tracker(lod, sound=voice.size > 0, smoothing=smoothing) as tracker:

        def hear(until_s: float) -> None:
            nonlocal heard
            end = min(int(until_s * _SOUND_RATE), voice.size)
            if end > heard:
                tracker.push_audio(voice[heard:end], heard / _SOUND_RATE, _SOUND_RATE)
                heard = end

        frames = 0
        for frame, time_s in _pictures(path):
            hear(time_s + _SOUND_AHEAD_S)
            yield _row(tracker.track(frame, time_s, color="i420", full_range=False))
            frames += 1
        if frames == 0:
            if voice.size == 0:
                raise MienError(f"{path} has neither pictures nor sound that ffmpeg can read")
            for i in range(int(voice.size / _SOUND_RATE * _FRAMES_A_SECOND)):
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


def _ffmpeg(path: Path, *options: str) -> subprocess.Popen[bytes]:
    command = ["ffmpeg", "-nostdin", "-v", "error", "-i", str(path), *options, "-"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)


def _samples(path: Path) -> npt.NDArray[np.float32]:
    """The sound of the whole file, one channel; empty where there is none."""
    with _ffmpeg(path, "-vn", "-ac", "1", "-ar", str(_SOUND_RATE), "-f", "f32le") as process:
        assert process.stdout is not None
        data = process.stdout.read()
    return np.frombuffer(data[: len(data) // 4 * 4], np.float32)


def _pictures(path: Path) -> Iterator[tuple[npt.NDArray[np.uint8], float]]:
    """Frames as I420 of even sizes, at a constant rate, with their times."""
    even = "scale=trunc(iw/2)*2:trunc(ih/2)*2:out_range=tv:out_color_matrix=bt601"
    with _ffmpeg(path, "-an", "-vf", even, "-pix_fmt", "yuv420p", "-f", "yuv4mpegpipe") as process:
        assert process.stdout is not None
        try:
            yield from _frames_of_y4m(process.stdout)
        finally:
            process.stdout.close()
            process.kill()


def _frames_of_y4m(stream: IO[bytes]) -> Iterator[tuple[npt.NDArray[np.uint8], float]]:
    header = stream.readline().decode("ascii", "replace").split()
    if not header:
        return
    fields = {field[0]: field[1:] for field in header[1:]}
    width, height = int(fields["W"]), int(fields["H"])
    numerator, denominator = (int(n) for n in fields["F"].split(":"))
    size = width * height * 3 // 2
    number = 0
    while stream.readline().startswith(b"FRAME"):
        data = stream.read(size)
        if len(data) < size:
            return
        yield np.frombuffer(data, np.uint8).reshape(height * 3 // 2, width), number * denominator / numerator
        number += 1
