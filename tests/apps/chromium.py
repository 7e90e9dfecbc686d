"""Headless Chromium, controlled by the DevTools protocol through two pipes."""
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time


def find():
    return next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None)


class Chromium:
    """A browser with one tab. Collects logs and exceptions of pages in `complaints`, and their requests in `requests`."""

    def __init__(self, program):
        self.profile = tempfile.mkdtemp(prefix="mien_chromium_")
        to_browser, self.outbox = os.pipe()
        self.inbox, from_browser = os.pipe()
        command = [program, "--headless", "--remote-debugging-pipe", "--no-sandbox", "--disable-gpu",
                   "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL without a graphics card "--disable-dev-shm-usage",
                   "--no-first-run", "--disable-background-networking", "--disable-component-update", "--mute-audio",
                   "--disable-background-timer-throttling", "--disable-backgrounding-occluded-windows",
                   "--disable-renderer-backgrounding", "--autoplay-policy=no-user-gesture-required",
                   f"--user-data-dir={self.profile}", "about:blank"]

        def connect():  # the browser reads file descriptor 3 and writes 4
            ends = [os.dup(to_browser), os.dup(from_browser)]
            high = [os.dup2(end, 100 + i) for i, end in enumerate(ends)]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        self.process = subprocess.Popen(command, preexec_fn=connect, pass_fds=(3, 4), start_new_session=True,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.received, self.number, self.session = b"", 0, None
        self.complaints, self.requests, self.loaded = [], [], False
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(domain + ".enable")

    def close(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        os.close(self.outbox)
        os.close(self.inbox)
        shutil.rmtree(self.profile, ignore_errors=True)

    def send(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.outbox, data):]
        deadline = time.monotonic() + 60  # for the reply, because the stream of events is unbounded
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def receive(self, deadline):
        while b"\0" not in self.received:
            if not select.select([self.inbox], [], [], max(0.0, deadline - time.monotonic()))[0]:
                raise TimeoutError("chromium does not respond")
            part = os.read(self.inbox, 1 << 16)
            if not part:
                raise RuntimeError("chromium has ended")
            self.received += part
        text, self.received = self.received.split(b"\0", 1)
        message = json.loads(text)
        self.note(message.get("method"), message.get("params", {}))
        return message

    def note(self, method, event):
        if method == "Page.loadEventFired":
            self.loaded = True
        elif method == "Network.requestWillBeSent":
            self.requests.append(event["request"]["url"])
        elif method == "Runtime.exceptionThrown":
            self.complaints.append(event["exceptionDetails"])
        elif method == "Log.entryAdded" and event["entry"]["level"] in ("warning", "error"):
            if "GPU stall due to ReadPixels" in event["entry"]["text"]:
                return  # reported for every WebGL canvas without a GPU
            self.complaints.append(event["entry"]["text"])
        elif method == "Runtime.consoleAPICalled":
            self.complaints.append(event["args"])

    def open(self, path):
        self.visit("file://" + os.path.abspath(path))

    def visit(self, url):
        self.loaded = False
        self.send("Page.navigate", url=url)
        deadline = time.monotonic() + 60
        while not self.loaded:
            self.receive(deadline)

    def evaluate(self, expression):
        """The value of JavaScript code, awaited if it is a promise; raises if the code throws."""
        answer = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True, userGesture=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"]["exception"].get("description", expression))
        return answer["result"].get("value")

    def save_downloads(self, folder):
        self.send("Page.setDownloadBehavior", behavior="allow", downloadPath=folder)
