"""Tests of the demo clip in many formats: rows, timestamps, the offset of its audio and the shape of the face must not change.

usage: media_matrix_test.py MIEN [CELLS]      CELLS: the number of combinations, default 30; all: every one
"""
import concurrent.futures
import csv
import itertools
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from report_page import Report

MIEN = sys.argv[1]
CELLS = sys.argv[2] if len(sys.argv) > 2 else "30"
SOURCE = pathlib.Path(__file__).resolve().parents[2]
CLIP = SOURCE / "tests/data/demo.mp4"
SECONDS = 1.0
H264 = ["-c:v", "libx264", "-preset", "ultrafast", "-crf", "18", "-pix_fmt", "yuv420p"]
MPEG4 = ["-c:v", "mpeg4", "-q:v", "2"]
MPEG2 = ["-c:v", "mpeg2video", "-q:v", "2"]
AAC, MP3, OPUS, PCM = ["-c:a", "aac"], ["-c:a", "libmp3lame"], ["-c:a", "libopus"], ["-c:a", "pcm_s16le"]

# Containers: ending, codecs, and whether they store late starts, non-square pixels, and a rotation.
CONTAINERS = {
    "mp4": (H264 + AAC, True, True, True), "mov": (["-c:v", "mjpeg", "-q:v", "2"] + PCM, True, True, True), "m4v": (MPEG4 + AAC, True, True, True),
    "mkv": (H264 + ["-c:a", "flac"], True, True, False), "webm": (["-c:v", "libvpx", "-deadline", "realtime", "-b:v", "2M"] + OPUS, True, True, False),
    "avi": (MPEG4 + MP3, False, True, False), "flv": (H264 + AAC, True, True, False), "ts": (H264 + AAC, True, True, False),
    "m2ts": (H264 + ["-c:a", "ac3"], True, True, False), "mpg": (MPEG2 + ["-c:a", "mp2"], True, False, False),
    "vob": (MPEG2 + ["-c:a", "ac3"], True, False, False), "ogv": (["-c:v", "libtheora", "-q:v", "9", "-c:a", "libvorbis"], False, True, False),
    "wmv": (["-c:v", "wmv2", "-b:v", "4M", "-c:a", "wmav2"], True, False, False), "nut": (["-c:v", "ffv1"] + PCM, True, True, False),
    "3gp": (MPEG4 + AAC, True, True, True),
}
RATES = {"30": 30.0, "25": 25.0, "30000/1001": 30000 / 1001, "12": 12.0}
OFFSETS = [0.0, 0.5, 2.0, -1.0]  # seconds by which the video starts after its audio
ASPECTS = {"1": 1.0, "4/3": 4 / 3, "8/9": 8 / 9}
ROTATIONS = [0, 90, 180, 270]
LAYOUTS = ["mono", "stereo", "5.1", "none"]
MPEG_RATES = {"25", "30", "30000/1001"}


def possible(container, rate, offset, aspect, rotation, layout):
    _, late, anamorphic, turns = CONTAINERS[container]
    return ((late or offset == 0) and (anamorphic or aspect == "1") and (turns or rotation == 0) and
            (rate in MPEG_RATES or container not in ("mpg", "vob")) and (layout != "5.1" or container not in ("flv", "wmv", "avi", "mpg", "3gp")) and
            (layout != "none" or offset == 0))


def chosen():
    """A fixed selection of `CELLS` combinations in which the values of each axis are about equally frequent."""
    cells = [cell for cell in itertools.product(CONTAINERS, RATES, OFFSETS, ASPECTS, ROTATIONS, LAYOUTS) if possible(*cell)]
    if CELLS == "all":
        return cells
    random.Random(40).shuffle(cells)
    counts, taken = {}, []
    while cells and len(taken) < int(CELLS):
        best = min(cells, key=lambda cell: sum(counts.get(value, 0) for value in enumerate(cell)))
        cells.remove(best)
        taken.append(best)
        for value in enumerate(best):
            counts[value] = counts.get(value, 0) + 1
    return taken


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
    if done.returncode != 0:
        raise AssertionError(f"{pathlib.Path(str(command[0])).name} ended with {done.returncode}: {done.stderr.decode(errors='replace')[-300:]}")
    return done


def track(path, folder):
    run(MIEN, "track", path, "--quiet", "--lod", "1", "--models", SOURCE / "models", "-o", folder / "rows.csv", "--stats", folder / "stats.json",
        "--landmarks", folder / "landmarks.csv")
    with open(folder / "rows.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    with open(folder / "landmarks.csv", newline="") as file:
        points = [[float(value) for value in row[1:]] if row[1] else None for row in list(csv.reader(file))[1:]]
    return rows, points, json.loads((folder / "stats.json").read_text())["input"]


def make(cell, path):
    """The first second of the clip, as recorded by such a camera."""
    container, rate, offset, aspect, rotation, layout = cell
    codecs = CONTAINERS[container][0]
    # With a rotated camera the width of pixels is along the height of the upright image.
    turn = {0: "", 90: ",transpose=cclock", 180: ",hflip,vflip", 270: ",transpose=clock"}[rotation]
    filters = f"fps={rate}{turn},scale=trunc(iw/({aspect})/2+0.5)*2:ih,setsar={aspect}"
    late = max(0.0, -offset)
    pulse = f"aevalsrc='0.5*sin(2*PI*500*t)*gte(t,0.5)':s=48000:d={SECONDS},aformat=channel_layouts={layout if layout != 'none' else 'mono'}"
    audio = ["-itsoffset", late, "-f", "lavfi", "-i", pulse] if layout != "none" else []
    maps = ["-map", "0:v", "-map", "1:a", "-ar", "48000" if container != "flv" else "44100"] if layout != "none" else ["-map", "0:v"]
    made = path.with_suffix(".plain." + container) if rotation else path
    if layout == "none":
        codecs = codecs[:codecs.index("-c:a")]
    run("ffmpeg", "-v", "error", "-y", "-itsoffset", max(0.0, offset), "-t", SECONDS, "-i", CLIP, *audio, *maps, "-vf", filters, "-vsync", "vfr",
        *codecs, made)
    if rotation:  # as cameras store it
        copy = ["-map", "0", "-c", "copy"]
        try:
            run("ffmpeg", "-v", "error", "-y", "-display_rotation", -rotation, "-i", made, *copy, path)
        except AssertionError:  # before ffmpeg 6
            run("ffmpeg", "-v", "error", "-y", "-i", made, *copy, "-metadata:s:v", f"rotate={360 - rotation}", path)


def onset(path, folder):
    """The start of the tone in seconds, from the waveform of a report."""
    run(MIEN, "track", path, "--quiet", "--lod", "1", "--mode", "audio", "--models", SOURCE / "models", "--report", folder / "r.html")
    report = Report(folder / "r.html")
    levels = report.columns["sound_high"]
    first = next(i for i, level in enumerate(levels) if level > max(0.3 * max(levels), 0.01))
    return (report.data["sound_start_ms"] + first * report.data["sound_bin_ms"]) / 1000


def shape(points):
    """The ratio of height and width of a face."""
    x, y = points[0::2], points[1::2]
    return (max(y) - min(y)) / (max(x) - min(x))


def check(cell, reference):
    container, rate, offset, aspect, rotation, layout = cell
    folder = pathlib.Path(tempfile.mkdtemp())
    try:
        path = folder / f"clip.{container}"
        make(cell, path)
        rows, points, facts = track(path, folder)
        problems = []
        times = [float(row["t_ms"]) / 1000 for row in rows]
        frames = round(SECONDS * RATES[rate])
        if abs(len(rows) - frames) > 1:
            problems.append(f"{len(rows)} rows instead of {frames}")
        steps = [b - a for a, b in zip(times, times[1:])]
        if any(abs(step - 1 / RATES[rate]) > 0.0021 for step in steps):
            problems.append(f"steps from {min(steps):.4f} to {max(steps):.4f} s")
        if layout != "none":
            # Containers and codecs start audio up to two of its frames early (priming).
            between = onset(path, folder) - times[0]
            if abs(between - (0.5 - offset)) > 0.06:
                problems.append(f"the tone begins {between:.3f} s after the video instead of {0.5 - offset:.3f}")
        width, height = facts["video"]["width"], facts["video"]["height"]
        if abs(width / height - 4 / 3) > 0.02:
            problems.append(f"a picture of {width} x {height}")
        if abs(facts["video"]["pixel_aspect"] - ASPECTS[aspect]) > 0.01 or facts["video"]["rotation"] != rotation:
            problems.append(f"stats: {facts['video']}")
        at = min(range(len(times)), key=lambda i: abs(times[i] - times[0] - 0.8))
        if points[at] is None:
            problems.append("no face")
        else:
            found = shape(points[at])
            if abs(found - reference) > 0.03:
                problems.append(f"a face {found:.3f} as high as wide instead of {reference:.3f}")
        return problems
    except (AssertionError, KeyError, StopIteration, subprocess.TimeoutExpired) as error:
        return [repr(error)]
    finally:
        shutil.rmtree(folder)


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    try:
        rows, points, _ = track(CLIP, folder)
        reference = shape(points[24])
    finally:
        shutil.rmtree(folder)
    cells = chosen()
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for cell, problems in zip(cells, pool.map(lambda cell: check(cell, reference), cells)):
            if problems:
                failed += 1
                print(" ".join(map(str, cell)) + ": " + "; ".join(problems), flush=True)
    print(f"{len(cells)} cells, {failed} failed")
    return 1 if failed or len(cells) < 30 else 0


if __name__ == "__main__":
    if not (SOURCE / "models/basenet.mien").exists() or not shutil.which("ffmpeg"):
        print("skipped: ffmpeg or the weights are missing")
        sys.exit(77)
    sys.exit(main())
