"""Runs the examples in C and C++ on an image of the demo clip and on inputs that they must reject.

usage: examples_test.py PROGRAM...
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MODELS = ROOT / "models"
PROGRAMS = []


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mien_examples_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def image(self, name, *options):
        path = self.folder / name
        subprocess.run(["ffmpeg", "-nostdin", "-v", "error", *options, "-frames:v", "1", path], check=True)
        return path

    def results(self, *arguments):
        return [subprocess.run([program, *arguments], capture_output=True, text=True) for program in PROGRAMS]

    def rejected(self, message, *arguments, status=1):
        for result in self.results(*arguments):
            self.assertEqual((result.returncode, result.stdout), (status, ""))
            self.assertRegex(result.stderr, message)

    def test_an_open_mouth(self):
        results = self.results(MODELS, self.image("face.ppm", "-ss", "4", "-i", ROOT / "tests/data/demo.mp4"))
        for result in results:
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertGreater(float(re.fullmatch(r"jawOpen (\d\.\d\d)\n", result.stdout)[1]), 0.2)
        self.assertEqual(len({result.stdout for result in results}), 1)

    def test_no_face(self):
        black = self.image("black.ppm", "-f", "lavfi", "-i", "color=black:size=64x48")
        self.assertEqual([(result.returncode, result.stdout) for result in self.results(MODELS, black)], [(0, "no face\n")] * len(PROGRAMS))

    def test_rejected_inputs(self):
        image = self.image("face.ppm", "-i", ROOT / "tests/data/demo.mp4")
        self.rejected("usage", MODELS, status=2)
        self.rejected("absent.ppm: cannot be read", MODELS, self.folder / "absent.ppm")
        self.rejected("jaw_open: .*absent", self.folder / "absent", image)
        for content in (image.read_bytes()[:-1], b"P5 2 2 255\n0000", b"P6 -2 2 255\n0000", b"P6 2 2 65535\n" + bytes(24)):
            damaged = self.folder / "damaged.ppm"
            damaged.write_bytes(content)
            self.rejected("damaged.ppm: cannot be read as a binary PPM of 8 bits", MODELS, damaged)


if __name__ == "__main__":
    PROGRAMS, sys.argv[1:] = sys.argv[1:], []
    unittest.main()
