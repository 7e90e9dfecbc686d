#!/usr/bin/env python3
"""Draws the tracker's result onto a camera's image, until q is pressed. Needs opencv-python.

usage: webcam.py [CAMERA or FILE] [--frames N] [--save IMAGE.png]
"""
import argparse
import time

import cv2
import mien


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", nargs="?", default="0")
    parser.add_argument("--frames", type=int, default=0, help="stop after this number of frames")
    parser.add_argument("--save", help="write the last image there and show no window")
    options = parser.parse_args()
    camera = cv2.VideoCapture(int(options.source) if options.source.isdigit() else options.source)
    if not camera.isOpened():
        raise SystemExit(f"webcam.py: no images from {options.source}")
    start, count, frame = time.monotonic(), 0, None
    with mien.Tracker(lod="auto") as tracker:
        while options.frames == 0 or count < options.frames:
            there, image = camera.read()
            if not there:
                break
            frame, count = image, count + 1
            # A file is read faster than it plays.
            at = camera.get(cv2.CAP_PROP_POS_MSEC) / 1000 if not options.source.isdigit() else time.monotonic() - start
            result = tracker.track(frame, at)
            mien.draw(frame, result)
            if not options.save:
                cv2.imshow("mien", frame)
                if cv2.waitKey(1) == ord("q"):
                    break
    if options.save and frame is not None:
        cv2.imwrite(options.save, frame)
    print(f"{count} frames, {result.controls!r}")


if __name__ == "__main__":
    main()
