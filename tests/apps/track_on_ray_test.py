#!/usr/bin/env python3
"""Tests of apps/examples/python/track_on_ray.py: order of work, and with Ray (PyPI), if available, a cluster of two workers, where one is killed.

usage: track_on_ray_test.py
A slow fake replaces the program and records each file.
"""
import importlib.util
import json
import os
import re
import signal
import stat
import subprocess
import sys
import tempfile
import threading
import time
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SCRIPT = os.path.join(ROOT, "apps", "examples", "python", "track_on_ray.py")
FILES = 12
specification = importlib.util.spec_from_file_location("track_on_ray", SCRIPT)
track_on_ray = importlib.util.module_from_spec(specification)
specification.loader.exec_module(track_on_ray)

# Like `mien track`: complete files appear under their names; exits with 3 for an invalid file. Records its work in `begun` and `done`.
STAND_IN = f"#!{sys.executable}\n" + """import os, sys, time
source, log = sys.argv[2], os.environ["STAND_IN_LOG"]
note = lambda what: open(log, "a").write(f"{what} {os.path.basename(source)} {os.getppid()}\\n")
if "bad" in source:
    sys.stderr.write(f"{source}: no video\\n")
    sys.exit(3)
note("begun")
time.sleep(0.5)
for i, word in enumerate(sys.argv):
    if word == "-o":
        partial = os.path.join(os.path.dirname(sys.argv[i + 1]), ".partial-" + os.path.basename(sys.argv[i + 1]))
        open(partial, "w").write("curves\\n")
        os.rename(partial, sys.argv[i + 1])
note("done")
"""


class BatchRay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="mien_ray_")
        self.addCleanup(self.folder.cleanup)
        os.makedirs(self.path("in/below"))
        with open(self.path("program"), "w") as file:
            file.write(STAND_IN)
        os.chmod(self.path("program"), stat.S_IRWXU)
        os.environ["STAND_IN_LOG"] = self.path("log")
        for i in range(FILES):
            open(self.path(f"in/{'below/' if i % 2 else ''}{i:02}.mp4"), "w").close()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def log(self, what):
        with open(self.path("log")) as file:
            return [line.split() for line in file if line.startswith(what)]

    def test_lists_match_the_program(self):
        with open(os.path.join(ROOT, "apps/mien/tracking/batch.cpp")) as file:
            source = file.read()
        self.assertEqual(re.findall(r'"(\.\w+)"', source[source.index("kRecordings"):source.index("};")]), track_on_ray.RECORDINGS)
        with open(os.path.join(ROOT, "apps/animation/animation.h")) as file:
            self.assertEqual(dict(re.findall(r'\{AnimationFormat::\w+, "([\w-]+)", "([.\w]+)"', file.read())), track_on_ray.ENDINGS)

    def test_finished_files_are_skipped(self):
        name = track_on_ray.recordings(self.path("in"), self.path("in/below"))
        self.assertEqual(len(name), FILES // 2, "outputs are not inputs")
        job = {"input": self.path("in/00.mp4"), "formats": ["csv", "glb"], "outputs": [self.path("out/a.csv"), self.path("out/a.glb")]}
        self.assertEqual(track_on_ray.track(job, self.path("program"), [])["outcome"], "done")
        self.assertEqual(track_on_ray.track(job, self.path("program"), [])["outcome"], "done before")
        os.remove(self.path("out/a.glb"))
        self.assertEqual(track_on_ray.track(job, self.path("program"), [])["outcome"], "done")
        later = time.time() + 5
        os.utime(self.path("in/00.mp4"), (later, later))
        self.assertFalse(track_on_ray.is_done(job))

    def test_failures_are_reported(self):
        open(self.path("in/bad.mp4"), "w").close()
        job = {"input": self.path("in/bad.mp4"), "formats": ["csv"], "outputs": [self.path("out/bad.csv")]}
        done = track_on_ray.track(job, self.path("program"), [])
        self.assertEqual(done["outcome"], "failed")
        self.assertIn("bad.mp4: no video", done["failure"])

    @unittest.skipUnless(importlib.util.find_spec("ray"), "SKIPPED: batches were NOT run on a cluster: ray (PyPI) is not installed")
    def test_a_killed_worker_is_replaced(self):
        from ray.cluster_utils import Cluster
        open(self.path("in/bad.mp4"), "w").close()
        cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0})
        self.addCleanup(cluster.shutdown)
        for _ in range(2):
            cluster.add_node(num_cpus=1)
        killed = []

        def kill_one():
            while not killed:
                time.sleep(0.05)
                begun = self.log("begun") if os.path.exists(self.path("log")) else []
                if len(begun) >= 4:
                    killed.append(begun[-1])
                    os.kill(int(begun[-1][2]), signal.SIGKILL)  # the worker

        killer = threading.Thread(target=kill_one)
        killer.start()
        command = [sys.executable, SCRIPT, self.path("in"), "--out", self.path("out"), "--address", cluster.address, "--mien", self.path("program"), "--json"]
        run = subprocess.run(command, capture_output=True, text=True, timeout=600)
        killer.join()
        self.assertEqual(run.returncode, 12, run.stderr)
        rows = {row["file"]: row["outcome"] for row in json.loads(run.stdout)}
        self.assertEqual(len(rows), FILES + 1)
        self.assertEqual([name for name, outcome in rows.items() if outcome == "failed"], ["bad.mp4"])
        for name in rows:
            if name != "bad.mp4":
                with open(self.path(f"out/{name}.csv")) as file:
                    self.assertEqual(file.read(), "curves\n", name)
        done = sorted(name for _, name, _ in self.log("done"))
        self.assertEqual(done, sorted(os.path.basename(name) for name in rows if name != "bad.mp4"), "each exactly once")
        self.assertEqual(len(self.log("begun")), FILES + 1, "the killed file was restarted")
        second = subprocess.run(command, capture_output=True, text=True, timeout=600)
        self.assertEqual({row["outcome"] for row in json.loads(second.stdout)}, {"done before", "failed"})


if __name__ == "__main__":
    unittest.main(verbosity=2)
