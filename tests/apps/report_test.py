#!/usr/bin/env python3
"""Tests of `mien track --report`: the data of the page, and the page in headless Chromium.

usage: report_test.py MIEN_PROGRAM      exit code 77: skipped, ffmpeg or the weights are missing
"""
import base64
import csv
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
import report_browser
import report_page

MIEN = None
SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
CLIP = os.path.join(SOURCE, "tests", "data", "demo.mp4")
HOSTILE = "<!--<script>'\"&.mp4"  # must be escaped in the page
FRAMES, FPS, BLACK = 45, 30, range(15, 24)  # of the clip; frames without a face
EXPORTS = {"csv": ".csv", "jsonl": ".jsonl", "llf": ".llf.csv", "gltf": ".gltf", "glb": ".glb", "bvh": ".bvh", "roblox": ".roblox.csv",
           "visemes": ".visemes.csv", "rhubarb": ".tsv", "rhubarb-json": ".rhubarb.json", "rhubarb-xml": ".xml", "rhubarb-dat": ".dat"}


def mien(*arguments, **more):
    return subprocess.run([MIEN, *arguments, "--models", os.path.join(SOURCE, "models")], check=True, timeout=300, capture_output=True, **more)


def ffmpeg(*arguments):
    subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", *arguments], check=True, timeout=120)


class Folder:
    """Files shared by all tests."""

    path = None

    @classmethod
    def make(cls):
        cls.path = tempfile.mkdtemp(prefix="mien_report_")
        black = f"drawbox=t=fill:color=black:w=iw:h=ih:enable='between(n,{BLACK[0]},{BLACK[-1]})'"
        ffmpeg("-t", str(FRAMES / FPS), "-i", CLIP, "-vf", black, "-crf", "18", cls.file(HOSTILE))
        outputs = [word for format, ending in EXPORTS.items() for word in ("-o", cls.file("x" + ending))]
        done = mien("track", cls.file(HOSTILE), "--report", cls.file("report.html"), "--landmarks", cls.file("landmarks.csv"),
                    "--stats", cls.file("stats.json"), "--quiet", *outputs)
        cls.printed = done.stdout

    @classmethod
    def file(cls, name):
        return os.path.join(cls.path, name)

    @classmethod
    def bytes(cls, name):
        with open(cls.file(name), "rb") as file:
            return file.read()


class Contents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.report = report_page.Report(Folder.file("report.html"))
        cls.rows = list(csv.DictReader(Folder.bytes("x.csv").decode().splitlines()))

    def same_column(self, name, values, unit):
        column = self.report.columns[name]
        self.assertEqual(len(column), len(values), name)
        for ours, value in zip(column, values):
            if value in ("", None):
                self.assertIsNone(ours, name)
            else:
                self.assertAlmostEqual(ours, float(value), delta=0.51 * unit, msg=name)

    def test_columns_are_the_curves(self):
        columns = {"t_ms": ("t_ms", 0.1), "face_probability": ("face_prob", 1e-4), "voice_activity": ("vad", 1e-4), "lod": ("lod", 1),
                   "pitch": ("pitch_rad", 1e-4), "yaw": ("yaw_rad", 1e-4), "roll": ("roll_rad", 1e-4), "x_m": ("tx_m", 1e-3),
                   "y_m": ("ty_m", 1e-3), "z_m": ("tz_m", 1e-3)}
        columns |= {"box_" + {"x": "x", "y": "y", "w": "width", "h": "height"}[k]: (k, self.report.data["landmark_unit"]) for k in "xywh"}
        columns |= {name: (name, 1e-4) for name in list(self.rows[0])[16:]}
        self.assertEqual(len(columns), 10 + 4 + 52)
        for name, (of_csv, unit) in columns.items():
            self.same_column(name, [row[of_csv] for row in self.rows], unit)
        states = ["searching", "tracking", "lost"]
        self.assertEqual([states[round(step)] for step in self.report.columns["status"]], [row["status"] for row in self.rows])
        self.assertIn("lost", [row["status"] for row in self.rows])

    def test_landmarks(self):
        rows = list(csv.reader(Folder.bytes("landmarks.csv").decode().splitlines()))[1:]
        found = self.report.landmarks()
        self.assertEqual(len(found), FRAMES)
        for row, points in zip(rows, found):
            for k, point in enumerate(points):
                if row[1 + 2 * k] == "":
                    self.assertIsNone(point)
                else:
                    for ours, value in zip(point, row[1 + 2 * k:3 + 2 * k]):
                        self.assertAlmostEqual(ours, float(value), delta=0.51 * self.report.data["landmark_unit"])

    def test_exports_equal_the_files_of_the_program(self):
        self.assertEqual([export["format"] for export in self.report.data["exports"]], list(EXPORTS))
        for export in self.report.data["exports"]:
            written = Folder.bytes("x" + EXPORTS[export["format"]])
            self.assertEqual(self.report.export(export["format"]), written, export["format"])
            self.assertEqual(export["bytes"], len(written))
            self.assertEqual(export["file"], HOSTILE.removesuffix(".mp4") + EXPORTS[export["format"]])

    def test_audio_and_stages(self):
        sound = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-i", Folder.file(HOSTILE), "-ac", "1", "-ar", "16000", "-f", "s16le", "-"],
                               check=True, capture_output=True, timeout=60).stdout
        samples = memoryview(sound).cast("h")
        low, high, bin = self.report.columns["sound_low"], self.report.columns["sound_high"], 160
        self.assertGreaterEqual(len(low), FRAMES * 100 // FPS - 5)
        for i in range(min(len(low), len(samples) // bin)):
            part = samples[i * bin:(i + 1) * bin]
            self.assertAlmostEqual(low[i], min(0, min(part)) / 32768, delta=0.6 / 127)
            self.assertAlmostEqual(high[i], max(0, max(part)) / 32768, delta=0.6 / 127)
        self.assertEqual(self.report.data["stages"], json.loads(Folder.bytes("stats.json"))["stages"])

    def test_the_clip_is_in_the_page(self):
        self.assertEqual(self.report.data["clip"], "in page")
        with open(Folder.file("clip.mp4"), "wb") as file:
            file.write(base64.b64decode(self.report.page.blocks["clip"], validate=True))
        probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=codec_name,nb_read_frames", "-of", "json",
                                Folder.file("clip.mp4")], check=True, capture_output=True, timeout=60).stdout
        streams = {stream["codec_name"]: stream for stream in json.loads(probe)["streams"]}
        self.assertEqual(int(streams["h264"]["nb_read_frames"]), FRAMES)
        self.assertIn("aac", streams)

    def test_the_clip_has_the_rotation_pixels_and_audio_track_of_the_curves(self):
        ffmpeg("-t", "0.5", "-i", CLIP, "-f", "lavfi", "-t", "0.5", "-i", "anullsrc=r=16000:cl=mono", "-map", "0:v", "-map", "1:a", "-map", "0:a",
               "-vf", "scale=480:480,setsar=4/3", Folder.file("odd.mkv"))
        mien("track", Folder.file("odd.mkv"), "--rotate", "270", "--audio-track", "2", "--report", Folder.file("odd.html"), "--quiet")
        odd = report_page.Report(Folder.file("odd.html"))
        with open(Folder.file("odd.mp4"), "wb") as file:
            file.write(base64.b64decode(odd.page.blocks["clip"], validate=True))
        probe = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=width,height,sample_aspect_ratio", "-of", "json",
                                Folder.file("odd.mp4")], check=True, capture_output=True, timeout=60).stdout
        stream = json.loads(probe)["streams"][0]
        self.assertEqual((odd.data["width"], odd.data["height"]), (360, 480))
        self.assertEqual((stream["width"], stream["height"], stream["sample_aspect_ratio"]), (360, 480, "1:1"))
        samples = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-i", Folder.file("odd.mp4"), "-f", "s16le", "-"], check=True,
                                 capture_output=True, timeout=60).stdout
        self.assertGreater(max(memoryview(samples).cast("h")), 100, "the second track, not the silent first")

    def test_names_are_escaped_and_nothing_is_loaded(self):
        self.assertEqual(self.report.data["name"], HOSTILE)
        self.assertEqual(Folder.printed, b"", "no curves on standard output with a report")
        for tag, name, value in self.report.page.attributes:
            if name in ("src", "href"):
                self.assertEqual((tag, value), ("link", "data:,"))
            self.assertFalse(name.startswith("on"), (tag, name))
            self.assertNotEqual(name, "style")

    def test_the_policy_permits_only_these_scripts_and_this_style(self):
        blocks = self.report.page.blocks
        viewer = report_page.unpack(blocks["viewer"]).decode()
        self.assertEqual(self.report.allowed("script"), [report_page.hash_of(blocks["script"]), report_page.hash_of(viewer)])
        self.assertEqual(self.report.allowed("style"), [report_page.hash_of(blocks["style"])])
        self.assertIn("default-src 'none'", self.report.page.policy)
        self.assertNotIn("'unsafe-", self.report.page.policy)

    def test_a_large_clip_is_stored_beside_the_page(self):
        mien("track", Folder.file(HOSTILE), "--duration", "0.2", "--quiet", "--report", Folder.file("b#side.html"), "--report-clip-mb", "0.001")
        beside = report_page.Report(Folder.file("b#side.html"))
        self.assertEqual((beside.data["clip"], beside.data["clip_file"], beside.page.blocks["clip"]), ("beside", "b#side.html.mp4", ""))
        self.assertTrue(Folder.bytes("b#side.html.mp4"))

    def test_audio_only_and_a_stream(self):
        ffmpeg("-i", Folder.file(HOSTILE), "-vn", Folder.file("voice.wav"))
        mien("track", Folder.file("voice.wav"), "--report", Folder.file("voice.html"), "--quiet")
        voice = report_page.Report(Folder.file("voice.html"))
        self.assertEqual((voice.data["width"], voice.data["clip"], voice.page.blocks["landmarks"]), (0, "in page", ""))
        self.assertGreater(max(voice.columns["jawOpen"]), 0.1)
        y4m = subprocess.run(["ffmpeg", "-v", "error", "-t", "0.2", "-i", CLIP, "-pix_fmt", "yuv420p", "-f", "yuv4mpegpipe", "-"],
                             check=True, capture_output=True, timeout=60).stdout
        mien("track", "-", "--report", Folder.file("stream.html"), "--quiet", input=y4m)
        stream = report_page.Report(Folder.file("stream.html"))
        self.assertEqual((stream.data["clip"], stream.data["name"], stream.frames()), ("none", "-", 6))

    def test_invalid_requests(self):
        for arguments, code, word in ((["--max-faces", "2"], 2, "a single face"), ([], 7, "cannot be written")):
            page = Folder.file("no such folder/x.html") if not arguments else Folder.file("x.html")
            with self.assertRaises(subprocess.CalledProcessError) as failed:
                mien("track", CLIP, "--report", page, *arguments)
            self.assertEqual(failed.exception.returncode, code)
            self.assertIn(word, failed.exception.stderr.decode())
            self.assertFalse(os.path.exists(page))

    def test_a_folder_of_reports(self):
        os.mkdir(Folder.file("in"))
        shutil.copy(Folder.file(HOSTILE), Folder.file("in/a.mp4"))
        again = lambda: json.loads(mien("track", Folder.file("in"), "--out", Folder.file("out"), "--reports", "--duration", "0.2", "--json").stdout)[0]
        first = again()
        self.assertEqual((first["outcome"], first["outputs"]), ("done", [Folder.file("out/a.mp4.csv"), Folder.file("out/a.mp4.html")]))
        self.assertEqual(report_page.Report(Folder.file("out/a.mp4.html")).export("csv"), Folder.bytes("out/a.mp4.csv"))
        self.assertEqual(again()["outcome"], "done before")
        os.remove(Folder.file("out/a.mp4.html"))
        self.assertEqual(again()["outcome"], "done")


@unittest.skipUnless(chromium.find(), report_browser.SKIPPED)
class Page(report_browser.PageTest):
    folder = Folder

    def test_shows_the_recording(self):
        self.open()
        self.assertEqual(self.js("document.title"), HOSTILE + " – mien report")
        self.assertEqual(self.js("document.querySelector('h1').textContent"), HOSTILE)
        self.assertTrue(self.js("report.player.clock instanceof VideoClock"))
        self.seek(300)
        self.assertGreater(self.drawn("#overlay"), 300)
        self.assertGreater(self.drawn("#face", "report.face.show(report.take.frameAt(300));"), 10000)
        self.assertGreater(self.drawn("[data-lane=jaw] canvas"), 300)
        self.press("l")
        self.assertEqual(self.drawn("#overlay"), 0)
        self.press("l")
        self.seek(1000 * (BLACK[-3] + 0.5) / FPS)
        self.assertEqual(self.drawn("#overlay"), 0)
        self.assertTrue(self.js("document.getElementById('face').classList.contains('absent')"))

    def test_values_equal_the_curves(self):
        self.open()
        rows = list(csv.DictReader(Folder.bytes("x.csv").decode().splitlines()))
        for i in (0, 7, FRAMES - 1):
            self.seek(float(rows[i]["t_ms"]) + 5)
            self.assertEqual(self.js("report.take.frameAt(report.player.clock.time_ms)"), i)
            self.assertAlmostEqual(float(self.js("document.querySelector('[data-lane=jaw] b').textContent")), float(rows[i]["jawOpen"]), delta=0.006)

    def test_tracking_time_in_words_of_users(self):
        self.open()
        stages = json.loads(Folder.bytes("stats.json"))["stages"]
        parts = {"detection": ["proposal"], "face": ["warp", "encoder", "heads", "decoders"], "audio": ["sound"], "all": ["frame"]}
        rows = json.loads(self.js("JSON.stringify([...document.querySelectorAll('#times tbody tr')].map(row => [...row.cells].map(cell => cell.textContent)))"))
        self.assertEqual(rows[-1][0], "all")
        self.assertEqual({name: text for name, text, _ in rows},
                         {name: f"{sum(stages[stage]['total_ms'] for stage in of if stage in stages) / FRAMES:.2f} ms" for name, of in parts.items()})
        self.assertGreater(sum(int(share.removesuffix(" %")) for _, _, share in rows[:-1]), 90)
        self.assertIn(f"95\u00a0% at most {stages['frame']['p95_ms']:.2f} ms", self.js("document.getElementById('times-note').textContent"))

    def test_pyramids_give_the_range_of_every_interval(self):
        self.open()
        self.assertEqual(self.js("""(() => {
          const steps = Int16Array.from({length: 3000}, (_, i) => (i * 7919 % 2003 < 100 ? none : i * 104729 % 30011 - 15000));
          const tree = new Pyramid(steps);
          let wrong = 0;
          for (let k = 0; k < 2000; ++k) {
            const from = k * 31 % 3000, to = Math.min(3000, from + k * 17 % 2900), known = steps.subarray(from, to).filter(step => step !== none);
            const wanted = known.length ? [Math.min(...known), Math.max(...known)] : null;
            if (JSON.stringify(tree.range(from, to)) !== JSON.stringify(wanted)) ++wrong;
          }
          return wrong; })()"""), 0)

    def test_by_keyboard(self):
        self.open()
        frame = "report.take.frameAt(report.player.clock.time_ms)"
        self.seek(0)
        self.press("ArrowRight")
        self.press("ArrowRight")
        self.wait(f"{frame} === 2", "two frames on")
        self.press("ArrowLeft")
        self.wait(f"{frame} === 1", "one back")
        self.press("+")
        self.press("+")
        self.assertAlmostEqual(self.js("report.view.length_ms"), (FRAMES / FPS * 1000) / 4, delta=20)
        self.assertIn("–", self.js("document.getElementById('window').textContent"))
        self.press("-")
        self.press("0")
        self.assertTrue(self.js("report.view.whole"))
        self.press("n")
        start = self.js("report.losses[0].start_ms")
        self.wait(f"Math.abs(report.player.clock.time_ms - {start}) < 2", "the time at which the face was lost")
        self.press("End")
        self.press("p")
        self.press("Home")
        self.wait("report.player.clock.time_ms < 1", "the beginning")
        self.js("""(() => { const speed = document.getElementById('speed'); speed.value = '0.25'; speed.dispatchEvent(new Event('change')); })()""")
        self.press(" ")
        self.wait("report.player.clock.time_ms > 50", "plays")
        self.press(" ")
        self.assertFalse(self.js("report.player.clock.playing"))
        # Tab and Enter reach and activate every control.
        self.js("document.querySelector('[data-name=mouthFunnel]').focus()")
        self.browser.send("Input.dispatchKeyEvent", type="keyDown", key="Enter", code="Enter", windowsVirtualKeyCode=13, text="\r")
        self.browser.send("Input.dispatchKeyEvent", type="keyUp", key="Enter", code="Enter", windowsVirtualKeyCode=13)
        self.assertEqual(self.js("document.querySelector('[data-name=mouthFunnel]').getAttribute('aria-pressed')"), "true")
        self.assertIn("mouthFunnel", self.js("document.querySelector('[data-lane=lips]').innerText"))
        self.assertEqual(self.js("[...document.querySelectorAll('button, input, select, summary')].filter(each => each.tabIndex < 0).length"), 0)
        self.assertEqual(self.js("[...document.querySelectorAll('button, input, select, canvas[role]')].filter(each => "
                                 "!(each.textContent.trim() || each.ariaLabel || each.closest('label'))).length"), 0)

    def test_by_pointer(self):
        self.open()
        where = json.loads(self.js("JSON.stringify(document.querySelector('[data-lane=jaw] canvas').getBoundingClientRect())"))
        self.js(f"scrollTo(0, {where['top']} - 200)")
        where = json.loads(self.js("JSON.stringify(document.querySelector('[data-lane=jaw] canvas').getBoundingClientRect())"))
        x, y = where["left"] + where["width"] / 2, where["top"] + 20
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        self.wait("Math.abs(report.player.clock.time_ms - (data.start_ms + data.end_ms) / 2) < 5", "a click on a curve seeks")
        self.browser.send("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-300, modifiers=2)
        self.wait("report.view.length_ms < 0.5 * (data.end_ms - data.start_ms)", "the wheel with Ctrl zooms")
        self.assertAlmostEqual(self.js("(report.view.start_ms + report.view.end_ms) / 2"), self.js("(data.start_ms + data.end_ms) / 2"), delta=30)

    def test_themes_and_widths(self):
        papers = set()
        for dark in (False, True):
            for width in (360, 390, 768, 1280):
                self.open(width=width, dark=dark)
                self.assertLessEqual(self.js("document.documentElement.scrollWidth - innerWidth"), 0, f"{width} wide")
                papers.add(self.js("getComputedStyle(document.body).backgroundColor"))
        self.assertEqual(len(papers), 2)

    def test_a_phone_shows_clip_face_and_controls_together(self):
        for width, height in ((390, 670), (390, 844), (844, 390)):
            self.open(width=width, height=height)
            boxes = {id: self.box("#" + id) for id in ("picture", "face", "transport")}
            shape = f"{width} x {height}: {boxes}"
            self.assertLessEqual(max(box[3] for box in boxes.values()), height, shape)
            self.assertGreaterEqual(boxes["transport"][1], max(boxes[id][3] for id in ("picture", "face")), shape)
            self.assertTrue(boxes["face"][0] >= boxes["picture"][2] or boxes["face"][1] >= boxes["picture"][3], shape)
            self.assertGreater(min(bottom - top for _, top, _, bottom in boxes.values()), 80, shape)

    def test_curves_use_their_height(self):
        self.open()
        self.js("document.querySelector('[data-preset=all]').click()")
        lanes = json.loads(self.js("""JSON.stringify(report.lanes.lanes.map(({lane: {key}, shown, range}) =>
          ({key, axis: range, values: [Math.min(...shown.map(each => each.range[0])), Math.max(...shown.map(each => each.range[1]))]})))"""))
        self.assertIn("lips", [lane["key"] for lane in lanes])
        for lane in lanes:
            if lane["key"] == "time":  # its outliers are outside
                continue
            (low, high), (least, most) = lane["axis"], lane["values"]
            self.assertTrue(low - 0.001 <= least and most <= high + 0.001, lane)
            self.assertTrue(most - min(0, least) > 0.55 * (high - low) or high - low <= 0.1 or lane["key"] == "head", lane)

    def test_axe_finds_nothing(self):
        package = os.path.join(SOURCE, "apps/web/node_modules/axe-core/axe.min.js")
        if not os.path.exists(package):
            self.skipTest("no axe-core here, which scripts/web.sh brings")
        with open(package, encoding="utf-8") as file:
            axe = file.read()
        for dark in (False, True):
            for width in (1280, 390):
                self.open(width=width, dark=dark)
                self.js(axe + "; 0")
                found = json.loads(self.js("axe.run().then(({passes, violations}) => JSON.stringify({passes: passes.length, violations}))"))
                self.assertEqual(found["violations"], [], f"{width} wide, {'dark' if dark else 'light'}")
                self.assertGreater(found["passes"], 30)

    def test_downloads(self):
        self.open()
        folder = tempfile.mkdtemp(dir=Folder.path)
        self.browser.save_downloads(folder)
        for name in ("glb", "gltf"):  # the page makes the second from the first
            self.js(f"document.querySelector('[data-format={name}]').click()")
            deadline = time.monotonic() + 30
            while not (files := glob.glob(os.path.join(glob.escape(folder), "*." + name))):
                self.assertLess(time.monotonic(), deadline, "no download")
                self.js("1")
                time.sleep(0.05)
            with open(files[0], "rb") as file:
                self.assertEqual(file.read(), Folder.bytes("x." + name))

    def test_a_clip_beside_the_page(self):
        mien("track", CLIP, "--duration", "0.3", "--quiet", "--report", Folder.file("large #1.html"), "--report-clip-mb", "0")
        self.open("large #1.html".replace("#", "%23").replace(" ", "%20"))
        self.assertTrue(self.js("report.player.clock instanceof VideoClock"))
        os.remove(Folder.file("large #1.html.mp4"))
        self.open("large #1.html".replace("#", "%23").replace(" ", "%20"))
        self.assertIn("expected as large #1.html.mp4 beside it.", self.js("document.getElementById('clip-note').textContent"))
        self.assertTrue(self.js("report.player.clock instanceof PageClock"))
        self.browser.complaints[:] = [text for text in self.browser.complaints if "ERR_FILE_NOT_FOUND" not in str(text)]


if __name__ == "__main__":
    MIEN = sys.argv.pop(1)
    report_browser.main(Folder, "reports")
