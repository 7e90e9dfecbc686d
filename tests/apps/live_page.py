"""Runs `mien live --page` for tests; the first arguments of the script are the program and the source folder."""
import contextlib
import http.client
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = sys.argv.pop(2)
PROGRAM = sys.argv.pop(1)
CLIP = SOURCE + "/tests/data/demo.mp4"
URL = re.compile(r"page: http://127\.0\.0\.1:(\d+)(/[0-9a-f]{32}/)\n")
JSON = {"Content-Type": "application/json"}


def arguments(*more):
    return [PROGRAM, "live", "--models", SOURCE + "/models", "--page", *map(str, more)]


class Live:
    """A running `mien live --page`."""

    def __init__(self, *more):
        self.process = subprocess.Popen(arguments(*more), stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
        line = self.process.stderr.readline()
        found = URL.fullmatch(line)
        if not found:
            raise RuntimeError(line + self.process.stderr.read())
        self.port, self.path = int(found[1]), found[2]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port}{self.path}"

    def request(self, target, method="GET", body=None, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        with contextlib.closing(connection):
            connection.request(method, target, body, headers or {})
            response = connection.getresponse()
            return response.status, response.read()

    def get(self, page):
        return self.request(self.path + page)

    def command(self, do, /, **values):
        return self.request(self.path + "command", "POST", json.dumps({"do": do, **values}), JSON)

    def raw(self, data):
        """What the server answers to bytes, until it closes or is silent."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=60) as client:
            client.sendall(data)
            client.shutdown(socket.SHUT_WR)
            answer = b""
            while part := client.recv(65536):
                answer += part
            return answer

    def events(self, wanted=lambda name, data: True, seconds=60, command=None):
        """The first event that is wanted, of those after the command."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=seconds)
        with contextlib.closing(connection):
            connection.request("GET", self.path + "events")
            response = connection.getresponse()
            if command:
                self.command(command)
            deadline = time.monotonic() + seconds
            while time.monotonic() < deadline:
                block = b""
                while not block.endswith(b"\n\n"):
                    line = response.readline()
                    if not line:
                        raise ConnectionError("the program has closed the events")
                    block += line
                lines = dict(line.split(": ", 1) for line in block.decode().split("\n") if ": " in line)
                if lines:
                    event, data = lines["event"], json.loads(lines["data"])
                    if wanted(event, data):
                        return data
        raise TimeoutError("no such event")

    def state(self, wanted=lambda state: True, command=None):
        return self.events(lambda name, data: name == "state" and wanted(data), command=command)

    def preview(self, seconds=60):
        """The preview, once a frame has come: until then the server answers 204."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            status, image = self.get("preview")
            if status != 204:
                return status, image
        raise TimeoutError("no preview")

    def stop(self):
        """The exit code after SIGINT."""
        self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=60)
        return self.process.returncode


def long_clip(folder, seconds=600):
    """A clip that lasts longer than a test, with the frames of the demo."""
    path = os.path.join(folder, "long.mp4")
    subprocess.run(["ffmpeg", "-v", "error", "-stream_loop", "-1", "-i", CLIP, "-c", "copy", "-t", str(seconds), path], check=True)
    return path


class Shared(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="mien_live_page_")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.clip = "test:" + long_clip(cls.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def live(self, *more):
        return self.enterContext(Live("--camera", self.clip, *more))
