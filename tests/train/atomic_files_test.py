"""Output files of training scripts are complete or absent, even if the script is killed."""
import random
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from mien_convert.atomic_files import whole, write_whole

BLOCKS, BLOCK = 64, 1 << 16
WRITES_FOR_EVER = f"""
import itertools, sys
from mien_convert.atomic_files import whole
for n in itertools.count():
    with whole(sys.argv[1]) as out:
        for _ in range({BLOCKS}):
            out.write(bytes([n % 256]) * {BLOCK})
    if n == 0:
        print(flush=True)
"""


class WholeFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "checkpoint.pt"

    def test_killed_at_any_moment(self):
        """Each run starts with the files that the killed one left."""
        dice, runs, left_behind = random.Random(5), 0, 0
        while runs < 25 or left_behind < 6 and runs < 300:  # a busy machine is often between two writes
            runs += 1
            self.path.unlink(missing_ok=True)
            process = subprocess.Popen([sys.executable, "-c", WRITES_FOR_EVER, self.path], stdout=subprocess.PIPE)
            process.stdout.readline()
            time.sleep(dice.uniform(0, 0.03))
            process.kill()
            process.communicate()
            written = self.path.read_bytes()
            self.assertEqual(len(written), BLOCKS * BLOCK)
            self.assertEqual(written, written[:1] * len(written), "of one write alone")
            left_behind += len(list(self.path.parent.iterdir())) > 1
        self.assertGreater(left_behind, 5, "some runs must be killed in the middle")
        write_whole(self.path, b"new")
        self.assertEqual([path.name for path in self.path.parent.iterdir()], [self.path.name], "nothing piles up")

    def test_an_error_keeps_what_was_there(self):
        write_whole(self.path, b"old")
        with self.assertRaises(ZeroDivisionError), whole(self.path) as out:
            out.write(b"n")
            raise ZeroDivisionError
        self.assertEqual(self.path.read_bytes(), b"old")
        self.assertEqual(len(list(self.path.parent.iterdir())), 1)


if __name__ == "__main__":
    unittest.main()
