"""Labels of several views of a portrait: the views are undone, sides stay apart, and scatter is measured."""
import os
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

from mien_training.data import label_portraits, portrait_labels
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS, INDEX

RIGHT, LEFT = np.array([80.0, 120]), np.array([150.0, 100])  # pupils of the subject; the right eye blinks
SIDE_POINTS = {side: [i for i, (name, _) in enumerate(lp.named_points()) if name.startswith(side)]
           for side in ("right", "left")}


def portrait():
    """A red right eye and a blue left one."""
    picture = np.full((224, 224, 3), 90, np.uint8)
    y, x = np.mgrid[:224, :224] + 0.5
    for centre, channel in ((RIGHT, 0), (LEFT, 2)):
        picture[np.hypot(x - centre[0], y - centre[1]) < 9, channel] = 255
    return picture


def centre(view, channel):
    """Mean of a colour's pixels; pixel edges lie at whole numbers."""
    weight = np.clip((view[..., channel] - 90.0) / 165, 0, 1)
    y, x = np.mgrid[:view.shape[0], :view.shape[1]] + 0.5
    return np.array([(x * weight).sum(), (y * weight).sum()]) / weight.sum()


def teacher(view):
    """Takes the eye further left for the right one, as MediaPipe does, and for one that blinks if it is red."""
    eyes = sorted((*centre(view, channel), channel == 0) for channel in (0, 2))
    points = np.tile(np.mean([eye[:2] for eye in eyes], 0), (len(lp.TEACHER), 1))
    points[SIDE_POINTS["right"]], points[SIDE_POINTS["left"]] = eyes[0][:2], eyes[1][:2]
    controls = np.zeros(len(CONTROLS))
    controls[INDEX["eyeBlinkRight"]], controls[INDEX["eyeBlinkLeft"]] = eyes[0][2], eyes[1][2]
    down, across = eyes[1][1] - eyes[0][1], eyes[1][0] - eyes[0][0]
    roll = -np.arctan2(down, across)  # of a camera space whose y points up
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]]
    pose[:3, 3] = [3, 0, -30]
    return points / view.shape[1::-1], controls, pose


class Views(unittest.TestCase):
    def setUp(self):
        self.found = label_portraits.answers(teacher, portrait(), np.random.default_rng(3))
        self.label = label_portraits.label(self.found, np.array([224, 224]), 336)

    def test_landmarks_return_to_the_picture(self):
        points = self.label["landmarks"] * 224
        np.testing.assert_allclose(points[label_portraits.PUPILS[0]], RIGHT, atol=0.15)
        np.testing.assert_allclose(points[label_portraits.PUPILS[1]], LEFT, atol=0.15)
        self.assertLess(self.label["landmark_scatter"], 0.01)

    def test_sides_stay_apart_in_mirrored_views(self):
        self.assertEqual(1, self.label["blendshapes"][INDEX["eyeBlinkRight"]])
        self.assertEqual(0, self.label["blendshapes"][INDEX["eyeBlinkLeft"]])
        self.assertEqual(0, self.label["control_scatter"].max())

    def test_rolled_views_agree(self):
        angles = [np.arctan2(pose[1, 0], pose[0, 0]) for _, _, pose in self.found]
        np.testing.assert_allclose(angles, np.arctan2(20, 70), atol=0.02)

    def test_the_border_does_not_move_the_head_away(self):
        matrix = self.label["matrix_colmajor"].reshape(4, 4).T
        self.assertAlmostEqual(-20, matrix[2, 3], places=4)

    def test_a_view_without_a_face_is_left_out(self):
        answers = iter([None, None] + [teacher] * 4)
        ask = lambda view: (answer := next(answers)) and answer(view)
        found = label_portraits.answers(ask, portrait(), np.random.default_rng(3))
        self.assertEqual(4, len(found))


def write(path, names, where):
    """Labels of images of 200 x 200 pixels, with all landmarks at one place, a share of the sides."""
    path.parent.mkdir(parents=True)
    count = len(names)
    np.savez(path, name=names, size_wh=np.full((count, 2), 200), landmarks=np.full((count, 175, 2), where),
             blendshapes=np.zeros((count, 52)), blendshape_names=CONTROLS,
             matrix_colmajor=np.tile(np.eye(4).ravel(), (count, 1)))


class Trust(unittest.TestCase):
    def test_scatter_lowers_it(self):
        controls = np.random.default_rng(1).uniform(0, 1, (500, len(CONTROLS))).astype(np.float32)
        scatter = np.zeros_like(controls)
        scatter[0] = 0.29
        table = {"control_scatter": scatter, "landmark_scatter": np.where(np.arange(500) == 0, 0.05, 0.01)}
        landmarks, of_controls = portrait_labels.trust(table, controls)
        self.assertAlmostEqual(0.5, landmarks[0], places=5)
        self.assertEqual(1, landmarks[1])
        np.testing.assert_allclose(of_controls[0], 0.5, atol=0.05)
        np.testing.assert_allclose(of_controls[1], 1, atol=1e-5)


class Averages(unittest.TestCase):
    def test_they_replace_the_labels_of_a_pack(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(
                os.environ, MIEN_DATA=folder + "/packs", MIEN_CACHE=folder + "/cache"):
            write(Path(folder) / "packs/faces/labels.npz", ["a.jpg", "b.jpg"], 0.25)
            write(Path(folder) / "cache/faces/labels.npz", ["b.jpg"], 0.5)
            labels = portrait_labels.of_pack("faces")
        self.assertEqual(["a.jpg", "b.jpg"], labels.name.tolist())
        self.assertEqual([50, 100], labels.points[:, 0, 0].tolist())

    def test_only_faces_of_the_chosen_splits_are_asked(self):
        table = {"name": np.array([f"{i}.jpg" for i in range(300)]), "group": np.full(300, "Black"),
                 "kind": np.array(["turned", "unlabelled"] * 150)}
        chosen = label_portraits.names_of(table, ["test"])
        self.assertTrue(chosen)
        for name in chosen:
            self.assertEqual("test", portrait_labels.split_of(name))
            self.assertEqual(0, int(name.partition(".")[0]) % 2)


if __name__ == "__main__":
    unittest.main()
