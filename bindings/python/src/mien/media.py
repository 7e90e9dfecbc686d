"""Files that ffmpeg can read: a row per frame of a video, from the package's `mien` program, and single images."""

from __future__ import annotations

import json
import re
import subprocess
import tempfile
import warnings
from pathlib import Path
from typing import Any, Iterable, Iterator, Literal, Mapping, Optional, Union, cast

import numpy as np
import numpy.typing as npt

from ._library import MODELS, PROGRAM
from .errors import MienError
from .result import Result
from .rows import Row
from .tracker import Color, Frame, Lod, Tracker, level
from .vocabulary import CONTROL_NAMES

_NOTE = "mien: note: "
# As the program's message (apps/mien/system/subprocess.cpp).
_INSTALL_FFMPEG = "install ffmpeg, for example with `apt install ffmpeg`, `brew install ffmpeg` or `winget install ffmpeg`"
_NAN = float("nan")
_STILL_FRAMES = 12  # after which smoothing and temporal decoders have settled
_CONTROLS = frozenset(CONTROL_NAMES)
_FACTS = [name for name in Row.__annotations__ if name not in _CONTROLS]


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

    Rows have the names, units and values of `mien track`'s CSV. Needs ffmpeg and ffprobe. The file is read while rows are taken: a damaged or truncated
    file raises MienError after its last valid row; other problems are warnings.

    lod: level of detail, 1..4 or "auto". sound: whether to use audio. smoothing: smooths small changes.
    backward: track backward from a detection through the frames before it, up to 3 seconds. While there is no face, rows are delayed by as much.
    audio_track: number of the audio track, from 1. rotation: clockwise rotation to upright in degrees, instead of the file's own.
    """
    if not Path(path).is_file():
        raise FileNotFoundError(f"no file {str(path)!r}")
    level(lod)
    options = ["--lod", str(lod), "--audio-track", str(audio_track)]
    options += [] if sound else ["--mode", "video"]
    options += [] if smoothing else ["--no-filter"]
    options += [] if backward else ["--no-backward"]
    options += [] if rotation is None else ["--rotate", str(rotation)]
    return _rows([*options, "--", str(Path(path).absolute())])


def columns(rows: Iterable[Row]) -> dict[str, npt.NDArray[Any]]:
    """Rows as one array for each name: pandas.DataFrame(mien.columns(mien.track_file(path))). Controls that are not predicted are NaN."""
    taken = cast("list[Mapping[str, object]]", list(rows))
    return {name: np.array([row.get(name, _NAN) for row in taken]) for name in ([*_FACTS, *CONTROL_NAMES] if taken else [])}


def track_image(image: Union[str, Path, Frame], *, lod: Lod = 4, color: Color = "bgr") -> Result:
    """The face in a single image: a file, or an array as in Tracker.track. Files need ffmpeg."""
    if isinstance(image, (str, Path)):
        image, color = _read_image(Path(image)), "rgb"
    with Tracker(lod, sound=False) as tracker:
        for i in range(_STILL_FRAMES):
            result = tracker.track(image, i / 30, color=color)
    return result


def _read_image(path: Path) -> Frame:
    if not path.is_file():
        raise FileNotFoundError(f"no file {str(path)!r}")
    command = ["ffmpeg", "-nostdin", "-v", "error", "-i", str(path.absolute()), "-frames:v", "1", "-f", "image2pipe", "-c:v", "ppm", "-pix_fmt", "rgb24", "-"]
    try:
        answer = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True)
    except OSError as error:
        reason = "not on PATH" if isinstance(error, FileNotFoundError) else error.strerror
        raise MienError(f"cannot run 'ffmpeg': {reason}; {_INSTALL_FFMPEG}") from error
    header = re.match(rb"P6\s(\d+)\s(\d+)\s255\s", answer.stdout)
    if answer.returncode != 0 or header is None:
        raise MienError(f"{path}: cannot be read as an image: {answer.stderr.decode('utf-8', 'replace').strip()}")
    width, height = int(header[1]), int(header[2])
    return np.frombuffer(answer.stdout, np.uint8, width * height * 3, header.end()).reshape(height, width, 3)


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
    row = {
        "frame": frame["frame"],
        "t_ms": frame["t_ns"] / 1e6,
        "status": frame["status"],
        "face_id": frame.get("face_id", 0),
        "face_prob": frame.get("face_prob", 0.0),
        "lod": frame["lod"],
        "vad": frame.get("vad", 0.0),
    }
    row.update(zip(("x", "y", "w", "h"), frame.get("box", [_NAN] * 4)))
    row.update({angle: head.get(angle, _NAN) for angle in ("pitch_rad", "yaw_rad", "roll_rad")})
    row.update(zip(("tx_m", "ty_m", "tz_m"), frame.get("position_m", [_NAN] * 3)))
    row.update(frame.get("controls", {}))
    return cast(Row, row)
