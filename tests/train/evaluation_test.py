#!/usr/bin/env python3
"""The evaluation: probes, metrics, and the report of missing data."""
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

from mien_training.data import portrait_duplicates
from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.evaluate import (
    evaluate_clips,
    evaluate_images,
    evaluate_leakage,
    evaluate_levels,
    evaluate_response,
    evaluate_wild,
    probes,
    program,
    report,
    summary,
    targets,
    teacher,
)
from mien_training.evaluate.inputs import PARTS

ROOT = Path(__file__).resolve().parents[2]



def decode(plan, gain=1.0):
    """What a perfect tracker, times `gain`, reads on three identities."""
    shown = np.stack(plan.controls)[plan.order]
    row = evaluate_response.read(gain * shown, plan)
    return {mark: np.stack([v] * 3) for mark, v in row.items()}


class Wild(unittest.TestCase):
    def decode(self, people=40):
        generator = np.random.default_rng(3)
        made = evaluate_wild.Answers.__new__(evaluate_wild.Answers)
        made.theirs = generator.random((people, len(CONTROLS)))
        made.controls, made.error = made.theirs.copy(), np.full(people, 0.05)
        made.trust, made.control_trust = np.ones(people), np.ones((people, len(CONTROLS)))
        made.followed = np.array([INDEX["jawOpen"], INDEX["mouthPucker"]])
        made.controls[:, INDEX["cheekPuff"]] = np.nan  # not driven
        return made

    def test_groups_are_told_apart(self):
        answers, group = self.decode(), np.repeat(["A", "B"], 20)
        answers.controls[20:, INDEX["jawOpen"]] *= -1
        answers.error[:5], answers.error[20] = np.inf, 0.2
        found = answers.by(group)
        self.assertEqual(found["A"], {"pictures": 20, "found": 0.75, "error": 0.05, "correlation": 1.0})
        self.assertEqual(found["B"], {"pictures": 20, "found": 0.95, "error": 0.05, "correlation": 0.0})

    def test_doubtful_labels_count_less(self):
        answers = self.decode()
        answers.error[:20], answers.trust[:20] = 0.1, 0.25
        self.assertEqual(0.06, answers.summary(np.ones(40, bool))["error"])
        answers.controls[:20, INDEX["jawOpen"]] *= -1
        answers.control_trust[:20] = 0
        self.assertEqual(1.0, answers.summary(np.ones(40, bool))["correlation"])

    def test_nobody_found_has_no_error(self):
        answers = self.decode()
        answers.error[:] = np.inf
        self.assertEqual(answers.summary(np.ones(40, bool)), {"pictures": 40, "found": 0.0, "error": None,
                                                              "correlation": None})


class Twins(unittest.TestCase):
    def test_the_same_photograph_is_one_whatever_its_size_and_light(self):
        rng = np.random.default_rng(1)
        big = np.uint8(np.kron(rng.integers(0, 200, (12, 12)), np.ones((20, 20))))
        points = np.float32([[0, 0], [239, 239]])
        half = np.uint8(big.reshape(120, 2, 120, 2).mean((1, 3)) * 0.8 + 30)
        one, same, other = (portrait_duplicates.small(p, q)
                            for p, q in ((big, points), (half, points / 2), (big[::-1].copy(), points)))
        self.assertEqual(portrait_duplicates.alike(np.stack([one, other]), same[None]).tolist(), [True, False])
        self.assertFalse(portrait_duplicates.alike(one[None], np.zeros((0, len(one)), np.float32)).any())


class Probes(unittest.TestCase):
    def test_every_control_alone_at_one_after_rest(self):
        plan = probes.control_plan()
        shown = np.stack(plan.controls)[plan.order]
        for i, c in enumerate(CONTROLS):
            np.testing.assert_array_equal(shown[plan.marks[c, "alone"]], np.tile(np.eye(52)[i], (probes.READ, 1)))
            self.assertFalse(shown[plan.marks[c, "alone", "rest"]].any())

    def test_slow_and_continuous(self):
        for plan in (probes.control_plan(), probes.pose_plan()):
            shown, angles = np.stack(plan.controls)[plan.order], np.array(plan.angles)[plan.order]
            self.assertLessEqual(np.abs(np.diff(shown, axis=0)).max(), 0.2 + 1e-6)
            self.assertLessEqual(np.abs(np.diff(angles, axis=0)).max(), probes.ANGLE_STEP)

    def test_turns_reach_both_ends_with_neutral_faces(self):
        plan = probes.pose_plan()
        self.assertFalse(np.any(plan.controls))
        angles = np.array(plan.angles)[plan.order]
        for axis, (name, most) in enumerate((("yaw", probes.YAW), ("pitch", probes.PITCH))):
            for degrees in (-most, most):
                self.assertTrue((angles[plan.marks[name, degrees], axis] == degrees).all())
        self.assertEqual(4, sum(mark[0] == "front" for mark in plan.marks))

    def test_eyes_turn_together(self):
        others = probes.companions()
        self.assertEqual({"eyeLookOutRight": 1.0}, others["eyeLookInLeft"])
        self.assertEqual({"eyeLookUpLeft": 1.0}, others["eyeLookUpRight"])


class Response(unittest.TestCase):
    def test_perfect_answers(self):
        scores = evaluate_response.scores(decode(probes.control_plan()))
        self.assertEqual((52, 52), (scores["reached_0.6"], scores["others_below_0.15"]))
        np.testing.assert_array_equal(scores["matrix"], np.eye(52))
        self.assertEqual({1.0}, {w["share"] for w in scores["winks"].values()})

    def test_weak_answers_and_cross_talk_are_seen(self):
        found = decode(probes.control_plan(), 0.5)
        found["jawOpen", "alone"][:, INDEX["mouthFunnel"]] = 0.4
        scores = evaluate_response.scores(found)
        self.assertEqual(0, scores["reached_0.6"])
        self.assertEqual(("jawOpen", "mouthFunnel", 0.4), scores["worst"][0])
        self.assertEqual(0.4, scores["controls"]["mouthFunnel"]["others_at_most"])
        self.assertEqual({0.0}, {w["share"] for w in scores["winks"].values()})

    def test_controls_that_are_not_driven_are_left_out(self):
        found = decode(probes.control_plan())
        for values in found.values():
            values[:, INDEX["tongueOut"]] = np.nan
        scores = evaluate_response.scores(found)
        self.assertNotIn("tongueOut", scores["controls"])
        self.assertEqual(51, scores["others_below_0.15"])


class Leakage(unittest.TestCase):
    def test_drift_is_from_the_frontal_answer(self):
        plan = probes.pose_plan()
        found = {mark: np.full((3, 52), 0.2) for mark in plan.marks}
        self.assertEqual(0.0, evaluate_leakage.scores(found)["largest"])
        found["yaw", -40] = found["yaw", -40] + np.array([[0.1], [-0.1], [0.1]]) * np.eye(52)[INDEX["jawOpen"]]
        scores = evaluate_leakage.scores(found)
        self.assertEqual(("jawOpen", 0.1), (scores["largest_control"], scores["largest"]))
        self.assertEqual(0.0, scores["controls"]["jawOpen"]["pitch"])


class Levels(unittest.TestCase):
    def test_difference_of_what_both_drive(self):
        a, b = np.full((5, 52), 0.5), np.full((5, 52), 0.25)
        a[:, 10:], b[0] = np.nan, np.nan
        self.assertEqual({"error": 0.25, "controls": 10}, evaluate_levels.difference(a, b))

    def test_fastest_round_without_the_search(self):
        stats = lambda ms, frames: {"frames": frames,
                                    "stages": {"frame": {"total_ms": ms * frames + 20}, "proposal": {"total_ms": 20}}}
        tracked = lambda ms, frames: program.Tracked(None, None, stats(ms, frames))
        rounds = [[tracked(2, 10), tracked(4, 30)], [tracked(3, 10), tracked(3, 30)]]
        self.assertAlmostEqual((2 * 10 + 3 * 30) / 40, evaluate_levels.cost(rounds))


class Teacher(unittest.TestCase):
    def test_a_constant_turn_is_no_difference(self):
        rotation = lambda a: np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
        theirs = np.stack([rotation(a) for a in (0.0, 0.3, -0.2)])
        ours = theirs @ rotation(0.5)
        np.testing.assert_allclose(teacher.pose_difference(ours, theirs), 0, atol=1e-4)

    def test_still_jitter_over_what_moves(self):
        zigzag = np.tile(np.array([[0.0], [1]]), (3, 52))
        pieces = [(zigzag, 0 * zigzag), (zigzag, 0 * zigzag)]
        rows = {"jawOpen": {"spread": 0.1, "correlation": 0.5}, "cheekPuff": {"spread": 0.0, "correlation": 0.5},
                "browInnerUp": {"spread": 0.1, "correlation": None}}
        self.assertEqual([4 / 6, 0.0], evaluate_clips.still_jitter(pieces, rows))


class Video(unittest.TestCase):
    def test_y4m_holds_frames_and_full_range(self):
        pictures = np.stack([np.full((5, 7, 3), v, np.uint8) for v in (0, 255)])
        header, *frames = program.y4m(pictures, [0, 0, 1])
        self.assertIn(b" W6 H4 ", header)
        self.assertEqual([b"FRAME\n" + bytes([0] * 24 + [128] * 12)] * 2, frames[:2])
        self.assertEqual(b"FRAME\n" + bytes([255] * 24 + [128] * 12), frames[2])


class Groups(unittest.TestCase):
    def test_lost_faces_count_but_have_no_error(self):
        error, chosen = np.array([0.1, np.nan, 0.3, 0.5]), np.array([True, True, True, False])
        table = evaluate_images.by_group(error, {"near": chosen, "none": np.zeros(4, bool)})
        self.assertEqual({"near": {"pictures": 3, "lost": 1, "error": 0.2}}, table)


class Reports(unittest.TestCase):
    def test_json_survives(self):
        table = {"a": [[1.0, None], [2, 3]], "b": {"c": "[x, y]", "d": []}}
        self.assertEqual(table, json.loads(report.dump(table)))

    def test_bars(self):
        goal = targets.Goal("leakage", "drift", "<=", 0.1, targets.at(targets.at, "largest"))
        cells = summary.line(goal, {"leakage": {"LOD1": {"largest": 0.2}, "LOD4": {"largest": 0.05}}})
        self.assertEqual(["drift", "<= 0.1", "**0.20**", "0.05"], cells)
        self.assertEqual("-", summary.line(goal, {})[2])

    def test_a_control_that_should_be_driven_is_missed(self):
        results = lambda spread: {"LOD1": {"controls": {"jawOpen": {"spread": spread, "correlation": None}}}}
        goal = targets.Goal("clips", "jawOpen", ">=", 0.9, targets.agreement("jawOpen", targets.at))
        self.assertEqual("**not driven**", summary.line(goal, {"clips": results(0.1)})[2])
        self.assertEqual("-", summary.line(goal, {"clips": results(0.001)})[2])

    def test_page_says_what_is_not_there(self):
        page = summary.page({}, ["images: the portraits are absent"], has_hifinet=False)
        self.assertIn("HiFiNet is not trained yet", page)
        self.assertIn("* images: the portraits are absent", page)


class Missing(unittest.TestCase):
    def test_empty_folders_are_said_and_counted(self):
        with tempfile.TemporaryDirectory() as folder:
            models = Path(folder) / "models"
            models.mkdir()
            environment = {**os.environ, "MIEN_DATA": folder, "MIEN_CACHE": folder}
            parts = [part for part in PARTS if part != "audio_and_video"]  # which needs only the program
            run = subprocess.run([sys.executable, "-m", "mien_training.evaluate", *parts, "--mien", sys.executable,
                                  "--models", models, "--out", f"{folder}/out"], env=environment, capture_output=True,
                                 text=True)
            self.assertEqual(3, run.returncode, run.stderr)
            page = Path(folder, "out/README.md").read_text()
            for said in ("clips of real people are absent", "rig pack is absent", "portraits are absent",
                         "no synthetic test sequences", "HiFiNet is not trained yet"):
                self.assertIn(said, page)
                self.assertIn(said, run.stderr)


if __name__ == "__main__":
    unittest.main()
