#!/usr/bin/env python3
"""Draws the head's axes into a frame of a video: Pose.project maps points of the head to the image. Needs
opencv-python.

usage: pose_axes.py FILE [--frame N] --save IMAGE.jpg
"""
import argparse

import cv2
import mien
import numpy as np

AXIS_M = 0.12
COLORS = {"x": (60, 60, 235), "y": (80, 190, 60), "z": (235, 140, 40)}  # BGR


def draw(image, pose):
    height, width = image.shape[:2]
    points = pose.project([[0, 0, 0], *(np.eye(3) * AXIS_M)], width, height).round().astype(int)
    for (name, color), end in zip(COLORS.items(), points[1:]):
        cv2.arrowedLine(image, tuple(map(int, points[0])), tuple(map(int, end)), color, 3, cv2.LINE_AA, tipLength=0.12)
        cv2.putText(image, name, tuple(map(int, end + (6, -6))), cv2.FONT_HERSHEY_SIMPLEX, 0.8, color, 2, cv2.LINE_AA)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("video")
    parser.add_argument("--frame", type=int, default=30)
    parser.add_argument("--save", required=True)
    options = parser.parse_args()
    video, result = cv2.VideoCapture(options.video), None
    with mien.Tracker(lod=1, sound=False) as tracker:
        for _ in range(options.frame + 1):
            there, image = video.read()
            if not there:
                raise SystemExit(f"pose_axes.py: {options.video} has no frame {options.frame}")
            result = tracker.track(image, video.get(cv2.CAP_PROP_POS_MSEC) / 1000)
    if not result.has_face:
        raise SystemExit(f"pose_axes.py: no face on frame {options.frame}")
    draw(image, result.pose)
    cv2.imwrite(options.save, image)
    pose = result.pose
    print(f"pitch {pose.pitch:.2f}, yaw {pose.yaw:.2f}, roll {pose.roll:.2f} rad, {-pose.translation[2]:.2f} m away")


if __name__ == "__main__":
    main()
