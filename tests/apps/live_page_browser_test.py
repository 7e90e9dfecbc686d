"""Tests of the page of `mien live --page` in headless Chromium. MIEN_SCREENSHOTS=FOLDER also saves screenshots.

usage: live_page_browser_test.py MIEN_PROGRAM SOURCE_FOLDER
"""
import base64
import json
import os
import time
import unittest
import urllib.parse

import chromium
from live_page import SOURCE, Live, Shared


@unittest.skipUnless(chromium.find(), "no Chromium")
class Page(Shared):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = chromium.Chromium(chromium.find())
        cls.addClassCleanup(cls.browser.close)
        cls.server = cls.enterClassContext(Live("--camera", cls.clip, "--mic", "none", "--send", "vmc://", "--send", "llf://"))

    def setUp(self):
        self.browser.complaints.clear()
        self.browser.requests.clear()

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])

    def js(self, script):
        return self.browser.evaluate(script)

    def wait(self, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not self.js(condition):
            self.assertLess(time.monotonic(), deadline, condition)
            time.sleep(0.05)

    def open(self, page=""):
        self.browser.visit(self.server.url + page)

    def open_and_wait(self):
        self.open()
        self.wait("document.getElementById('status').textContent === 'Tracking'")

    def click(self, selector):
        self.js(f"document.querySelector({json.dumps(selector)}).click()")

    def size(self, width, height, theme):
        self.browser.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500)
        self.browser.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])

    def test_shows_avatar_preview_and_state(self):
        self.open_and_wait()
        self.wait("!document.getElementById('preview').hidden && document.getElementById('image').width === 320")
        self.wait("document.querySelectorAll('#senders input:checked').length === 2")
        self.wait("document.getElementById('numbers').textContent.includes('per second')")
        self.assertEqual(self.js("document.getElementById('camera').value"), self.clip)
        places = {urllib.parse.urlsplit(url).netloc for url in self.browser.requests if not url.startswith(("data:", "blob:"))}
        self.assertEqual(places, {f"127.0.0.1:{self.server.port}"})

    def test_switches_a_sender(self):
        self.open_and_wait()
        self.wait("document.querySelectorAll('#senders input:checked').length === 2")
        self.click("#senders input")
        self.assertTrue(self.server.state(lambda state: state["senders"][0]["paused"]))
        self.wait("document.querySelector('#senders li').textContent.includes('paused')")
        self.click("#senders input")
        self.server.state(lambda state: not state["senders"][0]["paused"])

    def test_the_wizard_sets_gains_that_can_be_saved(self):
        self.browser.save_downloads(self.folder)
        self.open_and_wait()
        self.js("expressions.splice(3)")  # to save time
        self.click("#calibrate")
        self.wait("document.getElementById('step').textContent.startsWith('Look ahead')")
        self.wait("document.getElementById('step').textContent.startsWith('Open your mouth')")
        self.wait("document.getElementById('step').textContent.startsWith('Done')")
        state = self.server.state(lambda state: any(gain != 1 or dead for gain, dead in state["adjustments"]))
        self.assertTrue(all(0.5 <= gain <= 3 and 0 <= dead <= 0.3 for gain, dead in state["adjustments"]))
        self.click("#save")
        deadline = time.monotonic() + 60
        while not os.path.exists(self.path("mien-profile.json")):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.1)
        with open(self.path("mien-profile.json")) as file:
            self.assertIn("neutral", json.load(file))
        self.click("#reset")
        self.server.state(lambda state: all(pair == [1, 0] for pair in state["adjustments"]))

    def test_the_wizard_can_be_cancelled(self):
        self.open_and_wait()
        self.click("#calibrate")
        self.wait("document.getElementById('calibrate').textContent === 'Cancel'")
        self.click("#calibrate")
        self.wait("document.getElementById('calibrate').textContent === 'Calibrate' && document.getElementById('progress').hidden")

    def test_sliders_change_a_control(self):
        self.open_and_wait()
        self.js("""(() => {
          document.getElementById('adjustments-box').open = true;
          const slider = document.querySelector('[aria-label="Gain of jawOpen"]');
          slider.value = 2;
          slider.dispatchEvent(new Event('input'));
        })()""")
        self.server.state(lambda state: state["adjustments"][17] == [2.0, 0.0])
        self.click("#reset")
        self.server.state(lambda state: state["adjustments"][17] == [1.0, 0.0])

    def test_obs_is_transparent_around_a_moving_avatar(self):
        self.open("obs")
        self.wait("document.getElementById('face').width > 1")
        shot = """(() => {
          const face = document.getElementById('face'), copy = document.createElement('canvas');
          avatar.view.avatar.draw(avatar.view.face);
          [copy.width, copy.height] = [face.width, face.height];
          const context = copy.getContext('2d');
          context.drawImage(face, 0, 0);
          const {data} = context.getImageData(0, 0, copy.width, copy.height), at = (x, y) => data[4 * (y * copy.width + x) + 3];
          let sum = 0;
          for (let i = 0; i < data.length; i += 4) sum = (sum * 31 + data[i]) >>> 0;
          return {corner: at(2, 2), middle: at(copy.width >> 1, copy.height >> 1), sum};
        })()"""
        first = self.js(shot)
        self.assertEqual((first["corner"], first["middle"]), (0, 255))
        self.assertEqual(self.js("getComputedStyle(document.body).backgroundColor"), "rgba(0, 0, 0, 0)")
        deadline = time.monotonic() + 60
        while self.js(shot)["sum"] == first["sum"]:
            self.assertLess(time.monotonic(), deadline, "the avatar does not move")

    def test_nothing_is_wider_than_the_window(self):
        for theme in ("light", "dark"):
            for width, height in ((390, 844), (768, 1024), (1280, 800)):
                self.size(width, height, theme)
                self.open_and_wait()
                self.wait("!document.getElementById('preview').hidden")
                self.assertLessEqual(self.js("document.documentElement.scrollWidth"), width)
                self.save_screenshot(f"{theme}-{width}.png")

    def save_screenshot(self, name):
        folder = os.environ.get("MIEN_SCREENSHOTS")
        if folder:
            shot = self.browser.send("Page.captureScreenshot", captureBeyondViewport=True)
            with open(os.path.join(folder, name), "wb") as file:
                file.write(base64.b64decode(shot["data"]))

    def test_axe_finds_nothing(self):
        package = SOURCE + "/apps/web/node_modules/axe-core/axe.min.js"
        if not os.path.exists(package):
            self.skipTest("no axe-core here, which scripts/web.sh brings")
        with open(package) as file:
            axe = file.read()
        for theme in ("light", "dark"):
            self.size(1280, 800, theme)
            self.open_and_wait()
            self.js("document.getElementById('adjustments-box').open = true")
            self.js(axe + "; 0")
            found = json.loads(self.js("axe.run().then(({violations}) => JSON.stringify(violations))"))
            self.assertEqual([(violation["id"], [node["html"] for node in violation["nodes"]]) for violation in found], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
