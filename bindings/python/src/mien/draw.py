"""Draws a result into an image, with OpenCV or matplotlib, which are imported when they are needed."""

from __future__ import annotations

from typing import Any

import numpy as np

from .result import Result

_AXIS_M = 0.1
_COLORS = ((220, 40, 40), (40, 180, 60), (40, 110, 230))  # x, y, z of the head, RGB


def draw(on: Any, result: Result, *, focal_length_px: float = 0.0, controls: int = 8) -> None:
    """Draws landmarks, axes of the head and the highest controls of a face; without a face nothing.

    on: a BGR image, which OpenCV changes, or Axes of matplotlib that show the upright image.
    """
    if not result.has_face:
        return
    canvas: Any = _Image(on) if isinstance(on, np.ndarray) else _Axes(on)
    canvas.points(result.landmarks)
    width, height = canvas.size
    origin, *ends = result.pose.project([[0, 0, 0], *(np.eye(3) * _AXIS_M)], width, height, focal_length_px)
    for end, color in zip(ends, _COLORS):
        canvas.line(origin, end, color)
    highest = sorted(result.controls.items(), key=lambda item: -item[1])[:controls]
    canvas.text([f"{name} {value:.2f}" for name, value in highest])


class _Image:
    def __init__(self, image: Any) -> None:
        try:
            import cv2
        except ImportError as error:
            raise ImportError("mien.draw: drawing into an array needs OpenCV; pip install opencv-python") from error
        self.cv2, self.image, self.size = cv2, image, (image.shape[1], image.shape[0])

    def points(self, points: Any) -> None:
        for x, y in points.round().astype(int).tolist():
            self.cv2.circle(self.image, (x, y), 1, (0, 255, 0), -1)

    def line(self, start: Any, end: Any, color: Any) -> None:
        a, b = (tuple(p.round().astype(int).tolist()) for p in (start, end))
        self.cv2.arrowedLine(self.image, a, b, color[::-1], 2, self.cv2.LINE_AA, tipLength=0.12)

    def text(self, lines: list[str]) -> None:
        for i, line in enumerate(lines):
            self.cv2.putText(self.image, line, (8, 18 + 16 * i), self.cv2.FONT_HERSHEY_SIMPLEX, 0.45, (255, 255, 255), 1, self.cv2.LINE_AA)


class _Axes:
    def __init__(self, axes: Any) -> None:
        self.axes, self.size = axes, (max(axes.get_xlim()) + 0.5, max(axes.get_ylim()) + 0.5)

    def points(self, points: Any) -> None:
        self.axes.plot(points[:, 0], points[:, 1], ".", color="lime", markersize=2)

    def line(self, start: Any, end: Any, color: Any) -> None:
        self.axes.annotate("", end, start, arrowprops={"arrowstyle": "->", "color": [c / 255 for c in color]})

    def text(self, lines: list[str]) -> None:
        self.axes.text(0.02, 0.98, "\n".join(lines), transform=self.axes.transAxes, va="top", color="white", fontsize=8)
