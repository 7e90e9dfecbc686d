#!/usr/bin/env python3
"""Tests of users' avatars in reports, in headless Chromium: they move as the CSV says, their head is framed, and errors stay visible.

usage: report_avatar_test.py MIEN_PROGRAM      exit code 77: skipped, ffmpeg, Chromium or the weights are missing
"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

import avatar_files
import report_browser
import report_page

MIEN = None
SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
CLIP = os.path.join(SOURCE, "tests", "data", "demo.mp4")
OPENED = "!document.getElementById('default-avatar').hidden"
FAILED = "!document.getElementById('error').hidden"
VISEMES = {"viseme_aa": "aa", "viseme_PP": "PP", "viseme_E": "E", "viseme_O": "oh", "eyeBlinkLeft": None}


def mien(*arguments):
    return subprocess.run([MIEN, "track", CLIP, *arguments, "--start", "2", "--duration", "1", "--quiet", "--models", os.path.join(SOURCE, "models")],
                          timeout=300, capture_output=True, text=True)


class Folder:
    path = None

    @classmethod
    def make(cls):
        cls.path = tempfile.mkdtemp(prefix="mien_report_avatar_")
        files = {
            "me.glb": avatar_files.textured(["jawOpen", "mouthSmile_L", "other"]), "person.vrm": avatar_files.vrm(["open", "shut"]),
            "visemes.glb": avatar_files.avatar(list(VISEMES)), "mute.glb": avatar_files.avatar(["a1", "a2"]), "text.glb": b"not a model",
            "packed.glb": avatar_files.avatar(["jawOpen"], extensionsUsed=["KHR_draco_mesh_compression"], extensionsRequired=["KHR_draco_mesh_compression"])}
        for name, data in files.items():
            with open(cls.file(name), "wb") as file:
                file.write(data)
        for avatar in ("me.glb", "packed.glb"):
            outputs = ["-o", cls.file("me.csv"), "-o", cls.file("me.visemes.csv"), "-o", cls.file("animated.glb")]
            mien("--avatar", cls.file(avatar), "--report", cls.file(avatar + ".html"), *(outputs if avatar == "me.glb" else [])).check_returncode()

    @classmethod
    def file(cls, name):
        return os.path.join(cls.path, name)

    @classmethod
    def rows(cls, name):
        with open(cls.file(name), encoding="utf-8") as file:
            return list(csv.DictReader(file))


class CommandLine(unittest.TestCase):
    def test_the_report_contains_the_animated_avatar(self):
        report = report_page.Report(Folder.file("me.glb.html"))
        with open(Folder.file("animated.glb"), "rb") as file:
            self.assertEqual(report.export("glb"), file.read())
        self.assertEqual(report.data["avatar"], "me.glb")

    def test_invalid_requests(self):
        for avatar, arguments, code, message in (("me.glb", ["-o", Folder.file("x.csv")], 2, "no output for it"),
                                                 ("text.glb", ["--report", Folder.file("x.html")], 3, "not a .glb or .vrm")):
            done = mien("--avatar", Folder.file(avatar), *arguments)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(message, done.stderr)
            self.assertFalse(os.path.exists(Folder.file("x.html")))


class Page(report_browser.PageTest):
    folder = Folder

    def load(self, name):
        self.choose("#avatar-file", name)
        self.wait(f"{OPENED} || {FAILED}", f"{name} is not opened")
        self.assertEqual(self.error(), "")

    def error(self):
        return self.js("document.querySelector('#error').checkVisibility() ? document.querySelector('#error p').textContent : ''")

    def weights(self):
        return self.js("[...report.face.avatar.root.getObjectByName('face').morphTargetInfluences]")

    def camera(self):
        return self.js("report.face.avatar.camera.position.toArray()")

    def frames(self):
        for i, row in enumerate(Folder.rows("me.csv")):
            if i % 9 == 4:
                self.seek(float(row["t_ms"]) + 5)
                self.assertEqual(self.js("report.face.i"), i)
                yield i, row

    def test_moves_as_the_csv_says(self):
        self.open("me.glb.html")
        for _, row in self.frames():
            jaw, smile, other = self.weights()
            self.assertAlmostEqual(jaw, float(row["jawOpen"]), delta=1e-4)
            self.assertAlmostEqual(smile, float(row["mouthSmileLeft"]), delta=1e-4)
            self.assertEqual(other, 0)
            pitch, yaw, roll = (float(row[f"{name}_rad"]) / 2 for name in ("pitch", "yaw", "roll"))
            w = math.cos(pitch) * math.cos(yaw) * math.cos(roll) + math.sin(pitch) * math.sin(yaw) * math.sin(roll)
            y = math.cos(pitch) * math.sin(yaw) * math.cos(roll) - math.sin(pitch) * math.cos(yaw) * math.sin(roll)
            head = self.js("report.face.avatar.headBone.node.quaternion.toArray()")
            self.assertAlmostEqual(abs(head[3]), abs(w), delta=2e-4)
            self.assertAlmostEqual(head[1] * math.copysign(1, head[3] * w), y, delta=2e-4)
        self.assertEqual(self.js("report.face.avatar.root.getObjectByName('face').material.map.image.width"), 2)

    def test_visemes_move_a_mouth_without_a_jaw(self):
        self.open("me.glb.html")
        self.load("visemes.glb")
        self.wait("report.face.avatar.vocabularies.includes('Oculus')", "visemes.glb is not shown")
        rows = Folder.rows("me.visemes.csv")
        for i, row in self.frames():
            for weight, (target, viseme) in zip(self.weights(), VISEMES.items()):
                self.assertAlmostEqual(weight, float(rows[i][viseme] if viseme else row[target]), delta=1e-4, msg=target)

    def test_a_vrm_moves(self):
        self.open("me.glb.html")
        self.load("person.vrm")
        self.wait("report.face.avatar.vocabularies.includes('VRM')", "person.vrm is not shown")
        for _, row in self.frames():
            for weight, name in zip(self.weights(), ("jawOpen", "eyeBlinkLeft")):
                self.assertAlmostEqual(weight, float(row[name]), delta=1e-4)

    def test_the_head_fills_the_view_and_arms_are_lowered(self):
        self.open("me.glb.html")
        face = self.js(f"""(() => {{
          const {{camera, root}} = report.face.avatar, at = name => root.getObjectByName(name).getWorldPosition(camera.position.clone());
          const y = height => camera.position.clone().set(0, height, 0).project(camera).y;
          return [y({avatar_files.CHIN}), y({avatar_files.TOP}), ...['Left', 'Right'].map(side => at(side + 'ForeArm').sub(at(side + 'Arm')).y)]; }})()""")
        self.assertTrue(-1 < face[0] < face[1] < 1 and face[1] - face[0] > 0.8, face)
        self.assertLess(max(face[2:]), -0.4)
        self.seek(2500)
        self.assertGreater(self.drawn("#face", "report.face.show(12);"), 10000)

    def test_the_view_turns_zooms_and_resets(self):
        self.open("me.glb.html")
        left, top, right, bottom = self.box("#face")
        x, y, first = (left + right) / 2, (top + bottom) / 2, self.camera()
        mouse = lambda kind, x, y, **more: self.browser.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)
        mouse("mousePressed", x, y, button="left", clickCount=1)
        mouse("mouseMoved", x + 60, y, button="left", buttons=1)
        mouse("mouseReleased", x + 60, y, button="left", clickCount=1)
        self.assertLess(self.camera()[0], first[0] - 0.1)
        mouse("mouseWheel", x, y, deltaX=0, deltaY=-300)
        self.wait(f"report.face.avatar.camera.position.distanceTo(report.face.avatar.controls.target) < {0.95 * abs(first[2])}", "the wheel zooms")
        self.js("document.getElementById('reset-view').click()")
        for now, before in zip(self.camera(), first):
            self.assertAlmostEqual(now, before, places=6)

    def test_the_default_avatar_returns(self):
        self.open("me.glb.html")
        self.js("document.getElementById('default-avatar').click()")
        self.assertTrue(self.js("report.face.avatar instanceof Avatar && document.getElementById('reset-view').hidden"))
        self.seek(2500)
        self.assertGreater(self.drawn("#face", "report.face.show(12);"), 10000)
        self.load("me.glb")
        self.assertFalse(self.js("report.face.avatar instanceof Avatar"))

    def test_errors_stay_until_dismissed(self):
        self.open("me.glb.html")
        for name, message in (("text.glb", "text.glb: not a binary glTF file"), ("mute.glb", "mute.glb: no morph target or expression"),
                              ("packed.glb", "packed.glb: compressed with Draco, whose decoder is too large")):
            self.choose("#avatar-file", name)
            self.wait(FAILED, f"{name} is accepted")
            self.seek(2300)
            self.assertIn(message, self.error())
            self.assertEqual(len(self.weights()), 3, "the avatar stays")
            self.js("document.querySelector('#error button').click()")
            self.assertEqual(self.error(), "")

    def test_a_contained_avatar_without_a_decoder(self):
        self.open("packed.glb.html")
        self.assertIn("Draco", self.error())
        self.assertTrue(self.js("report.face.avatar instanceof Avatar"))

    def test_a_package_without_the_viewer(self):
        with open(Folder.file("me.glb.html"), encoding="utf-8") as file:
            text, count = re.subn('(<script[^>]* id="viewer">)[^<]*', r"\1", file.read())
        self.assertEqual(count, 1)
        with open(Folder.file("without.html"), "w", encoding="utf-8") as file:
            file.write(text)
        self.open("without.html")
        self.assertIn("cannot show your avatar", self.error())
        self.assertTrue(self.js("report.face.avatar instanceof Avatar"))

    def test_meshopt(self):
        package = os.path.join(SOURCE, "apps/web/node_modules/meshoptimizer")
        if not os.path.exists(package):
            self.skipTest("no meshoptimizer here, which scripts/web.sh brings")
        script = f"""import {{writeFileSync}} from 'node:fs'; import {{meshoptModel}} from '{SOURCE}/apps/web/tests/models.mjs';
          writeFileSync({json.dumps(Folder.file('meshopt.glb'))}, await meshoptModel(['jawOpen']));"""
        subprocess.run(["node", "--input-type=module", "-e", script], check=True, timeout=60)
        mien("--avatar", Folder.file("meshopt.glb"), "--report", Folder.file("meshopt.html")).check_returncode()
        self.open("meshopt.html")
        self.assertEqual(self.error(), "")
        positions = self.js("[...report.face.avatar.root.getObjectByName('face').geometry.attributes.position.array]")
        for ours, value in zip(positions, avatar_files.TRIANGLE):
            self.assertAlmostEqual(ours, value, places=6)


if __name__ == "__main__":
    MIEN = sys.argv.pop(1)
    report_browser.main(Folder, "avatars in reports", with_browser=True)
