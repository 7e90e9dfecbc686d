"""Checks on validation data through the program. Speaking people: frames of video and teacher meet, people's own level
does not count. Portraits: turned ones count separately."""
import os
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.phase2 import check_encoder

FRAMES, STEMS = 20, ["bbaf2n", "bbal7s", "bbas3a"]
UNSEEN = 7  # frame of each clip without a face according to the teacher


class CheckSpeech(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        pack = Path(folder.name) / "av"
        (pack / "video").mkdir(parents=True)
        for stem in STEMS:
            (pack / "video" / f"{stem}.mp4").touch()
        self.truth = np.random.default_rng(1).random((3 * FRAMES, 2))
        self.found = np.arange(3 * FRAMES) % FRAMES != UNSEEN
        np.savez(pack / "curves.npz", clip=STEMS, offset=np.arange(4) * FRAMES, blendshapes=self.truth,
                 blendshape_names=["mouthPucker", "jawOpen"], found=self.found)
        environment = mock.patch.dict(os.environ, {"MIEN_DATA": folder.name})
        environment.start()
        self.addCleanup(environment.stop)

    def track(self, path, lod):
        """A program that loses the face once, follows the jaw at a level of each clip's own, and inverts the pucker."""
        clip = STEMS.index(path.stem)
        pucker, jaw = self.truth[clip * FRAMES:(clip + 1) * FRAMES].T
        table = {name: np.zeros(FRAMES) for name in CONTROLS} | {"jawOpen": 0.3 * jaw + clip, "mouthPucker": -pucker}
        table["jawOpen"][[3, UNSEEN]] = 9
        return SimpleNamespace(table=table | {
            "t_ms": 40.0 * np.arange(FRAMES), "status": np.where(np.arange(FRAMES) == 3, "lost", "tracking")})

    def test_clips_have_the_rows_of_their_names(self):
        found = list(check_encoder.clips(2))
        self.assertEqual([path.stem for path, *_ in found], STEMS[::2])
        np.testing.assert_array_equal(found[1][1][:, INDEX["jawOpen"]], self.truth[2 * FRAMES:, 1])
        np.testing.assert_array_equal(found[1][2], self.found[2 * FRAMES:])
        self.assertTrue(np.isnan(found[0][1][:, INDEX["tongueOut"]]).all())

    def test_only_motion_within_a_clip_counts(self):
        rows = check_encoder.followed(self, 1, 1)
        self.assertEqual(set(rows), {"jawOpen", "mouthPucker"})
        self.assertAlmostEqual(rows["jawOpen"]["correlation"], 1, 3)
        self.assertAlmostEqual(rows["mouthPucker"]["correlation"], -1, 3)
        self.assertEqual([line.split() for line in check_encoder.speech_figures([rows, rows])],
                         [["jawOpen", "1.00", "1.00"], ["mouthPucker", "-1.00", "-1.00"]])


class CheckPortraits(unittest.TestCase):
    def test_turned_heads_count_separately(self):
        turned = np.radians([0, 20, 49, 51])
        portraits = mock.MagicMock(labels=SimpleNamespace(yaw=lambda: turned))
        portraits.__len__.return_value = 4
        right = np.array([True, True, False, False])
        summary = lambda rows: {"found": right[rows].mean(), "error": 0.0375, "correlation": 0.75}
        with mock.patch.object(check_encoder, "Answers", lambda *_: SimpleNamespace(summary=summary)):
            line = check_encoder.portrait_figures(None, 4, portraits)
        self.assertIn("50.0% of 4 correct, 66.7% of 3 up to 50 degrees", line)
        self.assertIn("error 0.0375, correlation 0.750", line)


if __name__ == "__main__":
    unittest.main()
