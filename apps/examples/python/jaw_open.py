#!/usr/bin/env python3
"""Prints how far the mouth of the face in an image is open, 0 to 1.

usage: jaw_open.py IMAGE
"""
import sys

import mien


def main():
    if len(sys.argv) != 2:
        raise SystemExit("usage: jaw_open.py IMAGE")
    result = mien.track_image(sys.argv[1])
    print(f"jawOpen {result.controls.jawOpen:.2f}" if result.has_face else "no face")


if __name__ == "__main__":
    main()
