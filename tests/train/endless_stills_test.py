"""Stills that are rendered while training runs: shards appear, are used, and are replaced by newer ones."""
import itertools
import os
import tempfile
import unittest
from argparse import Namespace
from pathlib import Path
from unittest import mock

import numpy as np

from mien_training.data import make_synthetic
from mien_training.data.face_batches import Rendered


class EndlessStills(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        environment = mock.patch.dict(os.environ, {"MIEN_CACHE": folder.name})
        environment.start()
        self.addCleanup(environment.stop)
        self.place = Path(folder.name) / "synthetic/train_stills"

    def shard(self, number, images=4):
        labels = {"controls": np.full(52, number / 100, np.float32), "identity": 0, "sequence": 0, "frame": 0}
        make_synthetic.save(self.place / f"shard_{number:04d}", [(np.zeros((8, 8, 3), np.uint8), labels)] * images)

    def numbers(self, worker, workers):
        args = Namespace(keep=3, count=None, workers=workers)
        return list(itertools.islice(make_synthetic.numbers_of(args, 2000, self.place, worker), 3))

    def test_workers_go_on_behind_the_last_shard(self):
        self.assertEqual(self.numbers(0, 1), [0, 1, 2])
        self.shard(4)
        self.assertEqual(self.numbers(0, 1), [5, 6, 7])
        self.assertEqual((self.numbers(0, 2), self.numbers(1, 2)), ([6, 8, 10], [7, 9, 11]))

    def test_a_count_ends(self):
        args = Namespace(keep=None, count=4001, workers=2)
        self.assertEqual([list(make_synthetic.numbers_of(args, 2000, self.place, k)) for k in (0, 1)], [[0, 2], [1]])

    def test_training_sees_the_newest_shards_only(self):
        for number in range(3):
            self.shard(number)
        rendered = Rendered("train_stills")
        self.assertEqual(len(rendered), 12)
        self.shard(3, images=6)
        make_synthetic.delete_old(self.place, 3)
        self.assertEqual(len(rendered), 12, "still mapped")
        self.assertEqual(rendered.shards[0][0].sum(), 0, "and readable")
        rendered.refresh()
        self.assertEqual(len(rendered), 14)
        self.assertAlmostEqual(float(rendered.shards[0][1]["controls"][0, 0]), 0.01, places=6)

    def test_stills_of_one_person_are_drawn_together(self):
        people = [dict.fromkeys(("window", "landmarks", "crop", "controls", "visibility"), np.ones((1, 4), np.float32))
                  | {"identity": k // 4, "sequence": k, "frame": 0} for k in range(40)]
        make_synthetic.save(self.place / "shard_0000", [(np.zeros((8, 8, 3), np.uint8), p) for p in people])
        rendered = Rendered("train_stills", alike=4)
        rendered.rows(np.random.default_rng(1), 32)
        drawn = rendered.last["identity"].view(-1, 4)
        self.assertTrue((drawn == drawn[:, :1]).all())
        self.assertGreater(len(drawn.unique()), 1)

    def test_a_person_has_several_stills_with_other_controls(self):
        people = [Namespace(identity=np.zeros(3), name=name) for name in "abcd"]
        figure, perform = mock.Mock(side_effect=lambda _, person, __: person.name), lambda rng, n: rng.random((n, 52))
        args = Namespace(split="train", alike=4, turned=0)
        parts = {"Set": mock.DEFAULT, "camera": mock.DEFAULT, "look": mock.Mock(sample=mock.Mock(side_effect=people)),
                 "Figure": figure, "shoot": lambda _, __, who, *rest: (who, {})}
        with mock.patch.multiple(make_synthetic, **parts):
            rng = np.random.default_rng(1)
            found = list(make_synthetic.stills(mock.MagicMock(), None, rng, args, 2000, perform, 10))
        self.assertEqual("".join(who for who, _ in found), "aaaabbbbcc")
        self.assertEqual([labels["identity"] for _, labels in found], [500] * 4 + [501] * 4 + [502] * 2)
        self.assertEqual(len({tuple(labels["controls"]) for _, labels in found}), 10)

    def test_nothing_is_deleted_with_a_count(self):
        self.shard(0)
        make_synthetic.delete_old(self.place, None)
        self.assertTrue((self.place / "shard_0000/labels.npz").exists())
