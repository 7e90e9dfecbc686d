#!/usr/bin/env python3
"""Compares two CSVs of `mien track`: the same frames, and equal values except for rounding, which differs between processors.

usage: scripts/cross/compare_curves.py CSV EXPECTED_CSV      exit status 1 if they differ
"""
import csv
import sys

# Controls are 0 to 1, angles in radians. Tiers differ by their rounding; half precision differs most.
TOLERANCE = 0.03
COMPARED_EXACTLY = ("frame", "t_ms", "status", "lod")


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def main():
    got, expected = (rows(path) for path in sys.argv[1:3])
    if len(got) != len(expected) or not expected or list(got[0]) != list(expected[0]):
        sys.exit(f"{sys.argv[1]}: other rows or columns (got {len(got)} rows, expected {len(expected)})")
    largest = (0.0, "none")
    for a, b in zip(got, expected):
        for name in b:
            if name in COMPARED_EXACTLY or b[name] == "" or a[name] == "":
                if a[name] != b[name]:
                    sys.exit(f"{sys.argv[1]}: frame {b['frame']}: {name}: got {a[name]!r}, expected {b[name]!r}")
                continue
            scale = float(b["w"]) if name in "xywh" else 1.0  # boxes, relative to the width of the face
            largest = max(largest, (abs(float(a[name]) - float(b[name])) / scale, f"{name} of frame {b['frame']}"))
    if not largest[0] <= TOLERANCE:  # also if it is not a number
        sys.exit(f"{sys.argv[1]}: {largest[1]}: wrong value (differs by {largest[0]:.4f}, expected at most {TOLERANCE})")
    print(f"{len(got)} frames, largest difference {largest[0]:.6f} ({largest[1]})")


if __name__ == "__main__":
    main()
