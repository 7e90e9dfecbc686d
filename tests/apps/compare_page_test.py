#!/usr/bin/env python3
"""Tests of the page of `mien compare` in headless Chromium.

usage: compare_page_test.py MIEN_PROGRAM      exit code 77: skipped, a program is missing
"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import chromium

FRAMES, FPS, SIZE = 30, 25, (64, 48)
HOSTILE = "<!--<script>'\".csv"  # must be escaped in the page
MIEN = None


def control_names():
    source = os.path.join(os.path.dirname(__file__), "..", "data", "demo_truth.csv")
    with open(source, encoding="ascii") as file:
        return file.readline().strip().split(",")[1:]


def write_curves(path, values, names):
    """values: name -> function of the frame number."""
    columns = ["t_ms", "pitch_rad", "yaw_rad", "roll_rad", *names]
    with open(path, "w", encoding="ascii") as file:
        print(",".join(columns), file=file)
        for frame in range(FRAMES):
            row = {"t_ms": frame * 1000 / FPS, "pitch_rad": 0, "yaw_rad": 0, "roll_rad": 0}
            row |= {name: value(frame) for name, value in values.items()}
            print(",".join(str(row.get(name, "")) for name in columns), file=file)


class ComparePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="mien_compare_")
        names = control_names()
        still = {name: lambda frame: 0 for name in names if name != "tongueOut"}
        write_curves(cls.path("still.csv"), still, names)
        blinks = still | {"eyeBlinkLeft": lambda frame: float(frame >= 10), "jawOpen": lambda frame: frame / FRAMES}
        write_curves(cls.path(HOSTILE), blinks, names)
        subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-f", "lavfi", "-i",
                        f"testsrc=size={SIZE[0]}x{SIZE[1]}:rate={FPS}:duration={FRAMES / FPS}", "-pix_fmt", "yuv420p",
                        cls.path("clip.mp4")], check=True, timeout=60)
        for page, more in (("plain.html", []), ("video.html", ["--video", cls.path("clip.mp4")])):
            subprocess.run([MIEN, "compare", cls.path("still.csv"), cls.path(HOSTILE), "--quiet", "-o", cls.path(page),
                            *more], check=True, timeout=60)
        cls.browser = chromium.Chromium(chromium.find())

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        shutil.rmtree(cls.folder)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def setUp(self):
        self.browser.complaints.clear()
        self.browser.requests.clear()

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])

    def open(self, page):
        self.browser.open(self.path(page))

    def run_js(self, script):
        return self.browser.evaluate(script)

    def wait(self, condition, what):
        deadline = time.monotonic() + 20
        while not self.run_js(condition):
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.05)

    def scrub_to(self, t_ms):
        self.run_js(f"""(() => {{
          const scrub = document.getElementById('scrub');
          scrub.value = {t_ms};
          scrub.dispatchEvent(new Event('input'));
        }})()""")

    def seek(self, t_ms):
        self.scrub_to(t_ms)
        self.wait(f"Math.abs(player.clock.time_ms - {t_ms}) < 2 && !document.getElementById('video').seeking", "seeking")
        # Faces are drawn within two frames.
        self.run_js("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def press(self, selector):
        self.run_js(f"document.querySelector({json.dumps(selector)}).click()")

    def side_of(self, which):
        return self.run_js(f"study.left === '{which}' ? 'left' : 'right'")

    def snapshot(self, side):
        """A hash of a face's pixels."""
        return self.run_js(f"document.getElementById('face-{side}').toDataURL()")

    def test_makes_no_network_requests(self):
        for page in ("plain.html", "video.html"):
            self.open(page)
            self.seek(400)
            self.assertEqual([url for url in self.browser.requests if not url.startswith(("file:", "blob:", "data:"))], [])

    def test_seeks_before_the_first_frame_is_drawn(self):  # which may be late on a busy machine
        script = self.browser.send("Page.addScriptToEvaluateOnNewDocument", source="window.requestAnimationFrame = () => 0;")
        self.addCleanup(self.browser.send, "Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])
        self.open("plain.html")
        self.scrub_to(400)
        self.assertEqual(self.run_js("player.clock.time_ms"), 400)

    def test_every_control_moves_the_face_on_its_side(self):
        self.open("plain.html")
        self.run_js("""(() => {
          const canvas = document.createElement('canvas');
          [canvas.width, canvas.height] = [360, 414];
          const ctx = canvas.getContext('2d', {willReadFrequently: true});
          const pixels = change => {
            const face = neutralFace();
            change(face);
            drawFace(ctx, face);
            return ctx.getImageData(0, 0, canvas.width, canvas.height).data;
          };
          const neutral = pixels(() => {});
          window.changed = change => {
            const now = pixels(change), count = {left: 0, right: 0};
            for (let i = 0; i < now.length; i += 4) {
              const apart = [0, 1, 2, 3].some(k => Math.abs(now[i + k] - neutral[i + k]) > 24);
              if (apart) ++count[(i / 4) % canvas.width < canvas.width / 2 ? 'left' : 'right'];
            }
            return count;
          };
        })()""")
        # One call per face, because software rendering on a busy machine is slow.
        changed = lambda change: self.run_js(f"changed(face => {{ {change}; }})")
        found = {name: changed(f"face.controls.{name} = 1") for name in self.run_js("data.controls")}
        found |= {angle: changed(f"face.{angle} = 0.3") for angle in ("pitch", "yaw", "roll")}
        self.assertEqual(changed(""), {"left": 0, "right": 0})
        self.assertEqual(len(found), 52 + 3)
        for name, count in found.items():
            self.assertGreater(count["left"] + count["right"], 60, name)
            # The subject's left is on the right of the image. Lips are connected, so their sides are compared by amount.
            if name.endswith("Left") and not name.startswith(("jaw", "mouthLeft")):
                self.assertGreater(count["right"], 2 * count["left"], name)
            if name.endswith("Right") and not name.startswith(("jaw", "mouthRight")):
                self.assertGreater(count["left"], 2 * count["right"], name)

    def test_the_face_shows_its_file(self):
        for page in ("plain.html", "video.html"):
            self.open(page)
            still, moving = self.side_of("a"), self.side_of("b")
            self.seek(0)
            before = {side: self.snapshot(side) for side in (still, moving)}
            self.seek(1000)
            self.assertEqual(self.snapshot(still), before[still])
            self.assertNotEqual(self.snapshot(moving), before[moving])
            self.assertEqual(self.run_js("faceAt(data.b, 399).controls.eyeBlinkLeft"), 0)  # a frame is held until the next
            self.assertEqual(self.run_js("faceAt(data.b, 400).controls.eyeBlinkLeft"), 1)

    def test_the_video_plays_and_sets_the_clock(self):
        self.open("video.html")
        video = "document.getElementById('video')"
        self.wait(f"{video}.readyState >= 2", "the video does not load")
        self.assertEqual(self.run_js(f"[{video}.videoWidth, {video}.videoHeight]"), list(SIZE))
        self.assertFalse(self.run_js("document.getElementById('video-figure').hidden"))
        self.run_js("player.clock.setRate(0.25)")  # otherwise a busy machine may miss the whole video
        self.press("#play")
        self.wait("player.clock.time_ms > 100", "the video does not play")
        # Pauses, or restarts if the video has already ended on a busy machine.
        self.assertTrue(self.run_js("""(() => {
          const before = player.clock.playing;
          document.querySelector('#play').click();
          return before !== player.clock.playing;
        })()"""))

    def test_without_a_video_the_page_has_a_clock(self):
        self.open("plain.html")
        self.assertTrue(self.run_js("document.getElementById('video-figure').hidden"))
        self.press("#play")
        self.wait("player.clock.time_ms > 300", "the clock does not run")
        self.press("#play")
        stopped = self.run_js("player.clock.time_ms")
        time.sleep(0.1)
        self.assertEqual(self.run_js("player.clock.time_ms"), stopped)

    def test_the_order_is_random(self):
        lots = set()
        for _ in range(40):  # fails by chance once in 5e11 runs
            self.open("plain.html")
            lots.add(self.run_js("study.left"))
            if len(lots) == 2:
                return
        self.fail(f"the left face was {lots} 40 times")

    def test_files_are_anonymous_until_the_vote_ends(self):
        self.open("plain.html")
        shown = self.run_js("document.body.innerText")
        self.assertNotIn(".csv", shown)
        self.assertIn("left better", shown)
        self.assertTrue(self.run_js("document.getElementById('results').hidden"))
        self.press("#reveal")
        self.assertIn("still.csv", self.run_js("document.body.innerText"))
        self.assertTrue(self.run_js("[...document.querySelectorAll('#votes button')].every(button => button.disabled)"))

    def test_votes_are_exported_with_file_names(self):
        self.open("plain.html")
        downloads = tempfile.mkdtemp(dir=self.folder)
        self.browser.save_downloads(downloads)
        sides = {"left": self.run_js("study.left").upper(), "right": self.run_js("study.right").upper()}
        for group, choice in (("eyes", "left"), ("jaw", "right"), ("brows", "same"), ("lips", "left"), ("lips", "right"),
                              ("head", "left"), ("head", "left")):  # one changed, one removed
            self.press(f"[data-group={group}][data-choice={choice}]")
        self.run_js("document.getElementById('participant').value = 'No. 7'")
        self.press("#export")
        deadline = time.monotonic() + 20
        while not (files := glob.glob(os.path.join(downloads, "votes-*.json"))):
            self.assertLess(time.monotonic(), deadline, "no download")
            self.run_js("1")
            time.sleep(0.05)
        with open(files[0], encoding="utf-8") as file:
            votes = json.load(file)
        self.assertRegex(votes.pop("exported_at"), r"^\d{4}-\d\d-\d\dT[\d:.]+Z$")
        self.assertEqual(votes, {
            "mien_compare": 1, "a": "still.csv", "b": HOSTILE, "left": sides["left"], "participant": "No. 7",
            "groups": ["eyes", "gaze", "brows", "jaw", "lips", "corners", "cheeks_nose", "head", "overall"],
            "votes": {"eyes": sides["left"], "brows": "same", "jaw": sides["right"], "lips": sides["right"]}})
        self.assertFalse(self.run_js("document.getElementById('results').hidden"))

    def test_statistics_and_curves(self):
        self.open("video.html")
        self.wait("document.getElementById('video').readyState >= 2", "the video does not load")
        self.press("#reveal")
        row = "[...document.querySelectorAll('#statistics tbody tr')].find(row => row.cells[0].textContent === '%s')"
        cells = self.run_js(f"[...({row % 'eyeBlinkLeft'}).cells].map(cell => cell.textContent)")
        self.assertEqual(cells, ["eyeBlinkLeft", "0.6667", "1.000", "0.40", "–", "0.000", "0.667", "0.00000", "0.03333", "30"])
        self.assertEqual(self.run_js(f"({row % 'tongueOut'}).className"), "undriven")
        charted = "[...document.querySelectorAll('.chart')].map(chart => chart.dataset.name)"
        self.assertEqual(self.run_js(charted)[:2], ["eyeBlinkLeft", "jawOpen"])
        self.run_js(f"({row % 'yaw'}).click()")
        self.assertEqual(self.run_js(charted)[-1], "yaw")
        self.run_js("""(() => {
          const canvas = document.querySelector('.chart canvas'), box = canvas.getBoundingClientRect();
          canvas.dispatchEvent(new MouseEvent('click', {clientX: box.x + box.width / 2, clientY: box.y + 5}));
        })()""")
        middle = self.run_js("(data.start_ms + data.end_ms) / 2")
        self.wait(f"Math.abs(player.clock.time_ms - {middle}) < 5", "a click on a curve does not seek")
        self.wait("Math.abs(parseFloat(document.querySelector('.cursor').style.left) - 50) < 1", "the cursor does not follow")


if __name__ == "__main__":
    missing = [name for name, there in (("chromium", chromium.find()), ("ffmpeg", shutil.which("ffmpeg"))) if not there]
    if missing:
        print(f"SKIPPED: the page of `mien compare` was NOT tested: {' and '.join(missing)} not available", file=sys.stderr)
        sys.exit(77)
    MIEN = sys.argv.pop(1)
    unittest.main(verbosity=2)
