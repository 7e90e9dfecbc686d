"""Reports in headless Chromium, and what tests of reports need."""
import os
import shutil
import sys
import time
import unittest

import chromium

SKIPPED = "SKIPPED: the page was NOT tested in a browser: chromium is not installed"


class PageTest(unittest.TestCase):
    """A browser for all tests of a class, whose pages must neither complain nor load anything. `folder.file` gives the path of a page."""

    folder = None

    @classmethod
    def setUpClass(cls):
        cls.browser = chromium.Chromium(chromium.find())

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def setUp(self):
        self.browser.complaints.clear()
        self.browser.requests.clear()

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])
        self.assertEqual([url for url in self.browser.requests if not url.startswith(("file:", "blob:", "data:"))], [])

    def js(self, script):
        return self.browser.evaluate(script)

    def wait(self, condition, what):
        deadline = time.monotonic() + 60
        while not self.js(condition):
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.05)

    def open(self, page="report.html", width=1280, height=900, dark=False):
        self.browser.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.browser.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.browser.open(self.folder.file(page))
        self.wait("!!report.whole_ms", "the page does not open")

    def press(self, key, code=None):
        for kind in ("keyDown", "keyUp"):
            self.browser.send("Input.dispatchKeyEvent", type=kind, key=key, code=code or key, **({"text": key} if len(key) == 1 and kind == "keyDown" else {}))

    def seek(self, t_ms):
        self.js(f"report.player.seek({t_ms})")
        self.wait(f"Math.abs(report.player.clock.time_ms - {t_ms}) < 2 && !document.getElementById('video').seeking", "seeking")
        self.js("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def box(self, selector):
        """Left, top, right and bottom of an element in the window."""
        return self.js(f"(({{left, top, right, bottom}}) => [left, top, right, bottom])(document.querySelector('{selector}').getBoundingClientRect())")

    def choose(self, selector, name):
        """Gives a file of the folder to an input."""
        root = self.browser.send("DOM.getDocument")["root"]["nodeId"]
        node = self.browser.send("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.browser.send("DOM.setFileInputFiles", nodeId=node, files=[os.path.abspath(self.folder.file(name))])

    def drawn(self, canvas, first=""):
        """The number of non-empty pixels of a canvas after `first`, because WebGL keeps its content only until the browser displays it."""
        return self.js(f"""(() => {{
          {first}
          const canvas = document.querySelector('{canvas}'), {{width, height}} = canvas;
          const copy = Object.assign(document.createElement('canvas'), {{width, height}}).getContext('2d', {{willReadFrequently: true}});
          copy.drawImage(canvas, 0, 0);
          return copy.getImageData(0, 0, width, height).data.filter((value, i) => i % 4 === 3 && value).length; }})()""")


def main(folder, subject, with_browser=False):
    """Runs the tests with the files that `folder.make` writes; exit code 77 where something that they need is missing."""
    weights = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "models", "basenet.mien")
    needed = {"ffmpeg": shutil.which("ffmpeg"), "Chromium": not with_browser or chromium.find(), "the weights": os.path.exists(weights)}
    missing = [name for name, found in needed.items() if not found]
    if missing:
        print(f"SKIPPED: {subject} were NOT tested: {' and '.join(missing)} not available", file=sys.stderr)
        sys.exit(77)
    folder.make()
    try:
        unittest.main(verbosity=2)
    finally:
        shutil.rmtree(folder.path)
