#!/usr/bin/env python3
"""Measures the latency of `mien live`, from the time at which an image of a clip is due until another process has
received its packet, and the frames that it drops.

ffmpeg decodes the clip before the measurement; a pipe feeds it to the program in a loop, so that every image is
available when it is due.

usage: live_latency.py [MIEN_PROGRAM] [--clip FILE] [--lod N ...] [--sound no|yes ...]
       [--minutes M]    prints a table in Markdown

The timestamps of images are the times at which they are due on the monotonic clock; packets of jsonl:// contain them.
On a busy machine, run it with `nice -n -10` (as root), so that the program waits less.
"""
import argparse
import json
import os
import socket
import subprocess
import tempfile
import threading
import time

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
FPS = 30
COLUMNS = ["level", "sound", "packets", "dropped pictures", "dropped packets", "median", "99 % within", "most",
           "CPU a packet", "memory after 1 minute", "at the end"]


class Clip:
    """An endless video, and its audio of a given length."""

    def __init__(self, file, folder, seconds):
        self.frames = round(seconds * FPS)
        y4m = subprocess.run(["ffmpeg", "-v", "error", "-i", file, "-an", "-r", str(FPS), "-pix_fmt", "yuv420p", "-f",
                              "yuv4mpegpipe", "-"],
                             check=True, capture_output=True).stdout
        self.header, self.body = y4m[:y4m.index(b"\n") + 1], y4m[y4m.index(b"\n") + 1:]
        width, height = (int(next(word[1:] for word in self.header.split() if word[:1] == key)) for key in (b"W", b"H"))
        self.picture_bytes = len(b"FRAME\n") + width * height * 3 // 2
        self.sound = folder + "/sound.wav"
        subprocess.run(["ffmpeg", "-v", "error", "-stream_loop", "-1", "-i", file, "-vn", "-t", str(seconds),
                        self.sound], check=True)

    def play(self, pipe):
        try:
            pipe.write(self.header)
            for i in range(self.frames):
                at = i * self.picture_bytes % len(self.body)
                pipe.write(memoryview(self.body)[at:at + self.picture_bytes])
            pipe.close()
        except BrokenPipeError:
            pass  # the program has ended with an error message


def resident_mb(process):
    with open(f"/proc/{process.pid}/status") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS"))


class Run:
    """One run of the program, from its first packet to its last."""

    def __init__(self, program, clip, with_sound, lod):
        receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(0.5)
        with tempfile.NamedTemporaryFile() as stats:
            live = subprocess.Popen([program, "live", "--camera", "test:-", "--mic",
                                     "test:" + clip.sound if with_sound else "none", "--lod", lod,
                                     "--quiet", "--models", SOURCE + "/models", "--stats", stats.name,
                                     "--send", f"jsonl://:{receiver.getsockname()[1]}"], stdin=subprocess.PIPE)
            feeder = threading.Thread(target=clip.play, args=(live.stdin,))
            feeder.start()
            self.late_ms, self.memory_mb = [], []
            self.listen(live, receiver)
            feeder.join()
            with open(stats.name) as file:
                self.stats = json.load(file)

    def listen(self, live, receiver):
        while True:
            try:
                packet = receiver.recv(65536)
            except TimeoutError:
                ended, _, usage = os.wait4(live.pid, os.WNOHANG)
                if ended:
                    self.cpu_ms = (usage.ru_utime + usage.ru_stime) * 1e3 / max(1, len(self.late_ms))
                    return
                continue
            self.late_ms.append((time.monotonic_ns() - json.loads(packet)["t_ns"]) * 1e-6)
            if len(self.late_ms) % FPS == 0:
                self.memory_mb.append(resident_mb(live))

    def row(self):
        late = sorted(self.late_ms)
        at = lambda share: f"{late[min(len(late) - 1, int(share * len(late)))]:.1f} ms"
        return [len(late), self.stats["dropped_pictures"], self.stats["frames"] - len(late), at(0.5), at(0.99), at(1),
                f"{self.cpu_ms:.2f} ms",
                *(f"{self.memory_mb[min(i, len(self.memory_mb)) - 1]:.1f} MB" for i in (60, len(self.memory_mb)))]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", nargs="?", default=SOURCE + "/build/release/apps/mien/mien")
    parser.add_argument("--clip", default=SOURCE + "/tests/data/demo.mp4")
    parser.add_argument("--lod", nargs="+", default=["1", "4"])
    parser.add_argument("--sound", nargs="+", default=["no", "yes"], choices=["no", "yes"])
    parser.add_argument("--minutes", type=float, default=0.5)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        clip = Clip(arguments.clip, folder, arguments.minutes * 60)
        print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
        for lod in arguments.lod:
            for sound in arguments.sound:
                row = [lod, sound, *Run(arguments.program, clip, sound == "yes", lod).row()]
                print("| " + " | ".join(map(str, row)) + " |", flush=True)


if __name__ == "__main__":
    main()
