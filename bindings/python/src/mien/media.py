"""Tracks files with the package's `mien` program: one row per frame of any file that ffmpeg can read."""

from __future__ import annotations

import json
import subprocess
import tempfile
import warnings
from pathlib import Path
from typing import Any, Iterable, Iterator, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

from ._library import MODELS, PROGRAM
from .errors import MienError
from .tracker import Lod
from .vocabulary import CONTROL_NAMES

Row = dict[str, Union[int, float, str]]

_NOTE = "mien: note: "


def track_file(
    path: Union[str, Path],
    *,
    lod: Lod = 4,
    sound: bool = True,
    smoothing: bool = True,
    audio_track: int = 1,
    rotation: Optional[Literal[0, 90, 180, 270]] = None,
    backward: bool = True,
) -> Iterator[Row]:
    """A row for every frame of a video, from video and audio together; 30 rows per second for a file without video.

    A row has time_s, status, face_id, face_probability, voice_activity, x, y, width, height (the face's box), pitch, yaw, roll,
    tx, ty, tz, and the 52 controls by name. Needs ffmpeg and ffprobe. The file is read while rows are taken: a damaged or truncated
    file raises MienError after its last valid row; other problems are warnings.

    backward: track backward from a detection through the frames before it, up to 3 seconds. While no face is seen, rows are as late.
    audio_track: number of the audio track, from 1. rotation: clockwise rotation to upright in degrees, instead of the file's own.
    """
    if not Path(path).is_file():
        raise FileNotFoundError(f"no file {str(path)!r}")
    options = ["--lod", str(lod), "--audio-track", str(audio_track)]
    options += [] if sound else ["--mode", "video"]
    options += [] if smoothing else ["--no-filter"]
    options += [] if backward else ["--no-backward"]
    options += [] if rotation is None else ["--rotate", str(rotation)]
    return _rows([*options, "--", str(Path(path).absolute())])


def columns(rows: Iterable[Row]) -> dict[str, npt.NDArray[np.generic]]:
    """Rows as one array for each name: pandas.DataFrame(mien.columns(mien.track_file(path)))."""
    taken = list(rows)
    return {name: np.array([row[name] for row in taken]) for name in (taken[0] if taken else {})}


def _rows(arguments: list[str]) -> Iterator[Row]:
    command = [str(PROGRAM), "track", "--quiet", "--models", str(MODELS), "--format", "jsonl", "-o", "-", *arguments]
    with tempfile.TemporaryFile() as log:  # a pipe that is not read would fill up and block the program
        try:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=log)
        except OSError as error:
            raise MienError(f"{PROGRAM} cannot be run: {error.strerror}") from error
        assert process.stdout is not None
        try:
            for line in process.stdout:
                if line.endswith(b"\n"):
                    yield _row(json.loads(line))
            status = process.wait()
        finally:  # also if the caller stops iterating
            process.stdout.close()
            process.kill()
            process.wait()
        log.seek(0)
        lines = log.read().decode("utf-8", "replace").splitlines()
        for message in lines:
            if message.startswith(_NOTE):
                warnings.warn(message[len(_NOTE) :], stacklevel=2)
        if status != 0:
            complaints = [message for message in lines if not message.startswith(_NOTE)]
            raise MienError(" ".join(complaints).replace("mien: ", "", 1) or f"{PROGRAM.name} ended with {status}")


def _row(frame: dict[str, Any]) -> Row:
    head = frame.get("head", {})
    controls = frame.get("controls", {})
    row: Row = {
        "time_s": frame["t_ns"] / 1e9,
        "status": frame.get("status", "searching"),
        "face_id": frame.get("face_id", 0),
        "face_probability": frame.get("face_prob", 0.0),
        "voice_activity": frame.get("vad", 0.0),
    }
    row.update(zip(("x", "y", "width", "height"), frame.get("box", [0.0] * 4)))
    row.update({angle: head.get(f"{angle}_rad", 0.0) for angle in ("pitch", "yaw", "roll")})
    row.update(zip(("tx", "ty", "tz"), frame.get("position_m", [0.0] * 3)))
    row.update({name: controls.get(name, 0.0) for name in CONTROL_NAMES})
    return row
