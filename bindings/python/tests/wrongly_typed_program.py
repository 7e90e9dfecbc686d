"""Mistakes that type checkers report: each line with "error" must be one. test.sh compares the numbers of the lines."""

from __future__ import annotations

import mien


def mistakes(row: mien.Row) -> None:
    row["jawopen"]  # error
    row["status"] = "sleeping"  # error
    row["t_ms"].upper()  # error
    mien.Tracker(lod="high")  # error
    mien.Tracker(max_faces="two")  # error
    mien.track_image("face.png", color="rbg")  # error
