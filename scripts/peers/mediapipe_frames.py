#!/usr/bin/env python3
"""Times MediaPipe's face landmarker, with blendshapes and head pose, on the frames of a clip, as JSON.  usage:
mediapipe_frames.py CLIP TASK_FILE

It follows the face from frame to frame, as mien does. The process runs on one
processor, so that its threads do not run in parallel.
"""
import json
import sys
import time
from importlib.metadata import distribution
from pathlib import Path

import mediapipe as mp
import numpy as np
from clip_frames import FPS, frames
from mediapipe.tasks.python import BaseOptions, vision

ROUNDS = 5  # of each frame the fastest counts, as in `mien bench --levels`


def main():
    clip, task = sys.argv[1:]
    options = vision.FaceLandmarkerOptions(base_options=BaseOptions(model_asset_path=task),
                                           running_mode=vision.RunningMode.VIDEO,
                                           output_face_blendshapes=True, output_facial_transformation_matrixes=True)
    pictures, times, faces = [mp.Image(image_format=mp.ImageFormat.SRGB, data=np.array(f)) for f in frames(clip)], [], 0
    with vision.FaceLandmarker.create_from_options(options) as landmarker:
        for i in range(ROUNDS * len(pictures)):
            begin = time.perf_counter_ns()
            result = landmarker.detect_for_video(pictures[i % len(pictures)], i * 1000 // FPS)
            times.append((time.perf_counter_ns() - begin) / 1e3)
            faces += len(result.face_blendshapes)
    fastest = np.reshape(times, (ROUNDS, -1)).min(0)
    package = distribution("mediapipe")
    shipped = package.locate_file("mediapipe/tasks/c/libmediapipe.so").stat().st_size + Path(task).stat().st_size
    print(json.dumps({"version": package.version, "bytes": shipped, "faces": faces / len(times),
                      "mean_us": fastest.mean(), "median_us": np.median(times)}))


if __name__ == "__main__":
    main()
