"""Training that is killed at any moment continues from its last checkpoint. Needs the data packs, and images that
continue_training.sh has made."""
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from mien_training.paths import cache, data

try:
    import torch
except ModuleNotFoundError:
    print("skipped: missing Python module torch", file=sys.stderr)
    sys.exit(77)

NEEDED = [data() / "faces_wild", cache() / "faces/misplaced.npy", cache() / "synthetic/train_stills",
          cache() / "synthetic/val_stills"]
FACES = 24 * 120


class KilledTraining(unittest.TestCase):
    def test_resumes_from_its_last_checkpoint(self):
        name = Path(tempfile.mkdtemp(prefix="killed_", dir=cache() / "runs")).name
        self.addCleanup(shutil.rmtree, cache() / "runs" / name)
        train = [sys.executable, "-m", "mien_training.phase1.train_encoder", "--name", name, "--batch", "24",
                 "--report-every", "240", "--resume", "--samples", str(FACES)]
        last, dice, seen = cache() / "runs" / name / "last.pt", random.Random(2), []
        for _ in range(5):
            process = subprocess.Popen(train, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            before = last.stat().st_mtime_ns if last.exists() else 0
            while process.poll() is None and (last.stat().st_mtime_ns if last.exists() else 0) == before:
                time.sleep(0.01)  # until it has gone on
            time.sleep(dice.uniform(0, 4))
            process.kill()
            process.wait()
            seen.append(self.samples(last))
        self.assertEqual(seen, sorted(set(seen)), "each went on from where the one before it was")
        self.assertLess(seen[-1], FACES, "all were killed on the way")
        subprocess.run(train, check=True, capture_output=True)
        self.assertGreaterEqual(self.samples(last), FACES)

    def samples(self, checkpoint):
        state = torch.load(checkpoint, map_location="cpu")
        self.assertEqual([report["samples"] for report in state["history"]][-1], state["samples"])
        self.assertTrue(all(torch.isfinite(value).all() for value in state["network"].values()))
        return state["samples"]


if __name__ == "__main__":
    if missing := [path.name for path in NEEDED if not path.exists()]:
        print("skipped: there is no", ", no ".join(missing), file=sys.stderr)
        sys.exit(77)
    os.nice(10)
    unittest.main()
