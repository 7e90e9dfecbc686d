#!/usr/bin/env python3
"""How late packets of `mien live` are: from when a picture of a replayed clip is due to when another process has its packet.

The clip is decoded beforehand (ffmpeg, to Y4M and WAV), so that a picture is there when it is due.

usage: live_latency.py [MIEN_PROGRAM] [--clip FILE] [--lod N ...] [--repeat N]    prints a table in Markdown

Pictures carry the time at which they were due on the machine's monotonic clock, and so do the packets of jsonl://.
"""
import argparse
import json
import os
import socket
import subprocess
import tempfile
import time

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")


def measure(program, clip, sound, lod):
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(0.5)
    stats = tempfile.mktemp()
    live = subprocess.Popen([program, "live", "--camera", "test:" + clip, "--mic", "test:" + sound if sound else "none", "--lod", lod, "--quiet",
                             "--models", SOURCE + "/models", "--stats", stats, "--send", f"jsonl://:{receiver.getsockname()[1]}"])
    late = []
    while True:
        try:
            packet = receiver.recv(65536)
        except TimeoutError:
            ended, status, usage = os.wait4(live.pid, os.WNOHANG)
            if ended:
                live.returncode = os.waitstatus_to_exitcode(status)
                break
            continue
        late.append((time.monotonic_ns() - json.loads(packet)["t_ns"]) * 1e-6)
    with open(stats) as file:
        dropped = json.load(file)["dropped_pictures"]
    os.remove(stats)
    return late, dropped, (usage.ru_utime + usage.ru_stime) * 1e3 / max(1, len(late))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", nargs="?", default=SOURCE + "/build/release/apps/mien/mien")
    parser.add_argument("--clip", default=SOURCE + "/tests/data/demo.mp4")
    parser.add_argument("--lod", nargs="+", default=["1", "4"])
    parser.add_argument("--repeat", type=int, default=1)
    arguments = parser.parse_args()
    folder = tempfile.TemporaryDirectory()
    raw, sound_file = folder.name + "/clip.y4m", folder.name + "/clip.wav"
    subprocess.run(["ffmpeg", "-v", "error", "-i", arguments.clip, "-pix_fmt", "yuv420p", raw, sound_file], check=True)
    print("| level | sound | packets | dropped pictures | median | 99 % within | most | CPU a packet |\n|---|---|---|---|---|---|---|---|")
    for lod in arguments.lod:
        for sound in (False, True):
            late, dropped, work = [], 0, []
            for _ in range(arguments.repeat):
                more, lost, cpu_ms = measure(arguments.program, raw, sound_file if sound else None, lod)
                late, dropped, work = late + more, dropped + lost, work + [cpu_ms]
            late.sort()
            at = lambda share: f"{late[min(len(late) - 1, int(share * len(late)))]:.1f} ms"
            print(f"| {lod} | {'yes' if sound else 'no'} | {len(late)} | {dropped} | {at(0.5)} | {at(0.99)} | {at(1)} | {sum(work) / len(work):.1f} ms |", flush=True)


if __name__ == "__main__":
    main()
