"""A program with types, checked by mypy --strict against the installed package."""

from __future__ import annotations

import mien
import numpy as np
import numpy.typing as npt


def jaw(frame: npt.NDArray[np.uint8], time_s: float) -> float:
    with mien.Tracker(lod="auto", max_faces=1) as tracker:
        result: mien.Result = tracker.track(frame, time_s, color="rgb", rotation=90)
        landmarks: npt.NDArray[np.float32] = result.landmarks
        yaw: float = result.pose.yaw
        return result.controls["jawOpen"] if result.has_face and landmarks.size and yaw else 0.0


def outputs(path: str) -> list[npt.NDArray[np.float32]]:
    return mien.run(path, np.zeros((3, 8, 8), np.float32))


def times(path: str) -> list[float]:
    return [row["t_ms"] for row in mien.track_file(path, lod=4) if row["status"] == "tracking"]


def gaze(row: mien.Row) -> float:
    return row["eyeLookUpLeft"] if "eyeLookUpLeft" in row else 0.0


def head(path: str) -> npt.NDArray[np.float64]:
    result = mien.track_image(path)
    if result.controls.jawOpen > 0.5:
        mien.draw(np.zeros((48, 64, 3), np.uint8), result)
    return result.pose.matrix
