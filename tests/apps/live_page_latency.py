#!/usr/bin/env python3
"""Measures how much later a client of `mien live --page` gets a frame than a receiver of --send, and the memory of the
program. Three clients read events and one reads previews, as a page and two OBS sources do. Prints JSON; the exit status
is 1 if a limit is exceeded.

usage: live_page_latency.py MIEN_PROGRAM SOURCE_FOLDER SECONDS
"""
import json
import selectors
import socket
import statistics
import sys
import tempfile
import threading
import time

from live_page import Live, long_clip

EVENT_CLIENTS = 3
PREVIEW_PAUSE_S = 0.05
WARM_UP_S = 20
MAX_MEDIAN_MS = 20
MAX_GROWTH_MB = 1


def resident_mb(process):
    with open(f"/proc/{process.pid}/status") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS"))


class Events:
    """A client of the events, which notes when each frame arrives."""

    def __init__(self, live):
        self.socket = socket.create_connection(("127.0.0.1", live.port))
        self.socket.sendall(f"GET {live.path}events HTTP/1.1\r\nHost: 127.0.0.1:{live.port}\r\n\r\n".encode())
        self.rest, self.arrivals = b"", {}

    def read(self, now):
        self.rest += self.socket.recv(1 << 20)
        *blocks, self.rest = self.rest.split(b"\n\n")
        for block in blocks:
            if block.startswith(b"event: frame\ndata: "):
                self.arrivals[json.loads(block.split(b"data: ", 1)[1])["n"]] = now


def read_previews(live, stop):
    while not stop.wait(PREVIEW_PAUSE_S):
        live.get("preview")


def measure(live, receiver, seconds):
    clients, packets = [Events(live) for _ in range(EVENT_CLIENTS)], {}
    selector = selectors.DefaultSelector()
    selector.register(receiver, selectors.EVENT_READ, None)
    for client in clients:
        selector.register(client.socket, selectors.EVENT_READ, client)
    begin = time.monotonic()
    sampled, memory = begin + min(WARM_UP_S, seconds / 2), []
    while time.monotonic() < begin + seconds:
        for key, _ in selector.select(0.1):
            now = time.monotonic()
            if key.data:
                key.data.read(now)
            else:
                packets[json.loads(receiver.recv(65536))["frame"]] = now
        if time.monotonic() > sampled:
            memory.append(round(resident_mb(live.process), 2))
            sampled += 1
    late = sorted((client.arrivals[n] - packets[n]) * 1e3 for client in clients for n in client.arrivals if n in packets)
    return {"seconds": seconds, "packets": len(packets), "frames_of_clients": [len(client.arrivals) for client in clients],
            "added_latency_ms": {"median": round(statistics.median(late), 2), "p99": round(late[len(late) * 99 // 100], 2)},
            "resident_mb": {"after_warm_up": memory[0], "most": max(memory), "at_the_end": memory[-1]}}


def exceeded(result):
    """The limits that the result exceeds."""
    median, memory = result["added_latency_ms"]["median"], result["resident_mb"]
    growth = memory["at_the_end"] - memory["after_warm_up"]
    if median > MAX_MEDIAN_MS:
        yield f"median added latency: {median} ms, limit {MAX_MEDIAN_MS} ms"
    if growth > MAX_GROWTH_MB:
        yield f"growth of memory: {growth:.2f} MB, limit {MAX_GROWTH_MB} MB"


def main(seconds):
    with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        receiver.bind(("127.0.0.1", 0))
        with Live("--camera", "test:" + long_clip(folder, seconds + 60), "--send", f"jsonl://:{receiver.getsockname()[1]}", "--quiet") as live:
            stop = threading.Event()
            previews = threading.Thread(target=read_previews, args=(live, stop))
            previews.start()
            try:
                result = measure(live, receiver, seconds)
            finally:
                stop.set()
                previews.join()
    print(json.dumps(result))
    sys.exit("; ".join(exceeded(result)) or 0)


if __name__ == "__main__":
    main(float(sys.argv[1]))
