"""Tests of `mien live` with a file as the camera, and independent receivers.

usage: live_test.py MIEN_PROGRAM SOURCE_FOLDER
"""
import contextlib
import csv
import functools
import http.server
import json
import os
import pty
import random
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import live_packets as decode
from datagrams import Receiver

SOURCE = sys.argv.pop(2)
PROGRAM = sys.argv.pop(1)
CLIP = SOURCE + "/tests/data/demo.mp4"
HELLO = b"iFacialMocap_sahuasouryya9218sauhuiayeta91555dy3719"


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def command(*arguments):
    return [PROGRAM, "live", "--models", SOURCE + "/models", *map(str, arguments)]


def run(*arguments, **more):
    return subprocess.run(command(*arguments), capture_output=True, timeout=120, **more)


def ffmpeg(*arguments):
    subprocess.run(["ffmpeg", "-v", "error", "-y", *arguments], check=True)


class Live(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, *arguments, **more):
        """A process that, with its children, is killed after its test or after 90 s."""
        process = subprocess.Popen(*arguments, start_new_session=True, **more)

        def kill():
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        late = threading.Timer(90, kill)
        late.start()
        self.addCleanup(process.wait)
        self.addCleanup(kill)
        self.addCleanup(late.cancel)
        return process

    def receiver(self, port=0):
        receiver = Receiver(port)
        self.addCleanup(receiver.close)
        return receiver

    def test_every_protocol_gets_the_same_face(self):
        receivers = {scheme: self.receiver() for scheme in ("vmc", "llf", "osf", "opentrack", "jsonl", "ifm")}
        place = lambda scheme, query="": f"{scheme}://127.0.0.1:{receivers[scheme].port}{query}"
        sends = [place("vmc", "?names=pascal,vrm0,vrm1"), place("llf", "?subject=Some%20one"), place("osf"), place("opentrack"),
                 place("jsonl"), f"ifm://:{free_port()}?to=127.0.0.1:{receivers['ifm'].port}"]
        done = run("--camera", "test:" + CLIP, "--stats", self.path("stats"), *[word for url in sends for word in ("--send", url)])
        self.assertEqual(done.returncode, 0, done.stderr)
        got = {scheme: receiver.packets() for scheme, receiver in receivers.items()}
        frames = [json.loads(packet) for packet in got["jsonl"]]
        with open(self.path("stats")) as file:
            stats = json.load(file)
        self.assertEqual(stats["frames"], len(frames))
        self.assertEqual(stats["dropped_packets"], 0)
        self.assertGreater(len(frames), 20)  # of 240; depends on the machine
        self.assertEqual(sorted(f["t_ns"] for f in frames), [f["t_ns"] for f in frames])
        tracked = [f for f in frames if f["status"] == "tracking"]
        self.assertGreater(len(tracked), len(frames) / 2)
        control = lambda frame, name: frame["controls"].get(name, 0.0)

        for frame, packet in zip(frames, got["llf"], strict=True):
            llf = decode.live_link(packet)
            self.assertEqual(llf["subject"], "Some one")
            if llf["values"]:
                self.assertLess(abs(llf["values"][17] - control(frame, "jawOpen")), 1e-6)
                self.assertLess(abs(llf["values"][52] - frame.get("head", {"yaw_rad": 0})["yaw_rad"]), 1e-6)
        for frame, packet in zip(frames, got["ifm"], strict=True):
            self.assertLessEqual(abs(decode.ifacialmocap(packet)["values"]["jawOpen"] - 100 * control(frame, "jawOpen")), 0.501)
        for frame, packet in zip([f for f in frames if "head" in f], got["opentrack"], strict=True):
            self.assertLess(abs(decode.opentrack(packet)["z"] - 100 * frame["position_m"][2]), 1e-9)
        for frame, packet in zip(tracked, got["osf"], strict=True):
            osf = decode.openseeface(packet)
            self.assertEqual((osf["size"], osf["success"], osf["id"]), ((640, 480), 1, frame["face_id"]))
            x, y, w, h = frame["box"]
            inside = [x - w < u < x + 2 * w and y - h < v < y + 2 * h for u, v in osf["landmarks"]]
            self.assertTrue(all(inside))
            self.assertGreater(-osf["translation"][2], 1)
            eyes = [osf["landmarks"][i] for i in (36, 45)]  # the subject's right eye is on the left of the image
            self.assertLess(eyes[0][0], eyes[1][0])
        bundles, whole = [], []
        for packet in got["vmc"]:
            bundles.append(packet)
            if b"/VMC/Ext/Blend/Apply\0" in packet:
                whole.append(decode.vmc(bundles))
                bundles = []
        for frame, vmc in zip(frames, whole, strict=True):
            self.assertEqual(list(vmc["blends"]), decode.PASCAL + decode.VRM0 + decode.VRM1)
            for name, of in (("JawOpen", "jawOpen"), ("A", "jawOpen"), ("aa", "jawOpen"), ("Blink_L", "eyeBlinkLeft")):
                self.assertLess(abs(vmc["blends"][name] - control(frame, of)), 1e-6)
        self.check_jaw(frames)

    def check_jaw(self, frames):
        """The curve follows the reference, wherever in the clip the first frame is."""
        with open(SOURCE + "/tests/data/demo_truth.csv") as file:
            truth = [float(row["jawOpen"]) for row in csv.DictReader(file)]
        first = frames[0]["t_ns"]
        shown = {round((f["t_ns"] - first) * 30e-9): f["controls"].get("jawOpen", 0.0) for f in frames}

        def correlation(lag):
            pairs = [(value, truth[i + lag]) for i, value in shown.items() if i + lag < len(truth)]
            a, b = zip(*pairs)
            ma, mb = sum(a) / len(a), sum(b) / len(b)
            spread = lambda x, m: sum((v - m) ** 2 for v in x) ** 0.5
            return sum((x - ma) * (y - mb) for x, y in pairs) / max(1e-9, spread(a, ma) * spread(b, mb))
        self.assertGreater(max(correlation(lag) for lag in range(45)), 0.8)

    def test_a_lost_face_is_held_and_eases_to_rest(self):
        ffmpeg("-t", "5", "-i", CLIP, "-vf", "drawbox=enable='gte(t,2.5)':t=fill:color=black", "-an", self.path("lost.mp4"))
        receiver = self.receiver()
        done = run("--camera", "test:" + self.path("lost.mp4"), "--lod", 1, "--send", f"jsonl://:{receiver.port}")
        self.assertEqual(done.returncode, 0, done.stderr)
        frames = [json.loads(packet) for packet in receiver.packets()]
        lost = next(i for i, f in enumerate(frames) if f["status"] == "lost")
        before, first_s = frames[lost - 1], frames[lost]["t_ns"] * 1e-9
        for frame, previous in zip(frames[lost:], frames[lost - 1:]):
            since = frame["t_ns"] * 1e-9 - first_s
            if since < 0.45:
                self.assertEqual((frame["controls"], frame["position_m"]), (before["controls"], before["position_m"]))
            passed = (frame["t_ns"] - previous["t_ns"]) * 1e-9
            for name, value in frame["controls"].items():
                self.assertLessEqual(abs(value - previous["controls"][name]), 1.6 * passed + 1e-6, name)  # 1 in 1 s, smoothly
            for angle in ("pitch_rad", "yaw_rad", "roll_rad"):
                self.assertLessEqual(abs(frame["head"][angle] - previous["head"][angle]), 2.5 * passed + 1e-6)
        self.assertGreater(frames[-1]["t_ns"] * 1e-9 - first_s, 1.6)
        self.assertLess(max(frames[-1]["controls"].values()), 0.01)
        self.assertLess(max(abs(frames[-1]["head"][a]) for a in ("pitch_rad", "yaw_rad", "roll_rad")), 1e-6)
        self.assertEqual(frames[-1]["position_m"], before["position_m"])

    def test_a_lost_camera_is_reopened(self):
        ffmpeg("-t", "2", "-i", CLIP, "-an", "-c", "copy", "-f", "mpegts", self.path("clip.ts"))
        with open(self.path("clip.ts"), "rb") as file:
            film = file.read()
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        connections = []

        def serve():
            for video_is_over in (True, False):
                try:
                    connection, _ = server.accept()
                    connections.append(connection)
                    connection.sendall(film)
                    while not video_is_over:  # at the rate of a camera, because detection may be slow
                        for start in range(0, len(film), 4096):
                            connection.sendall(film[start:start + 4096])
                            time.sleep(0.05)
                except OSError:  # the test has ended
                    pass
                connection.close()
        threading.Thread(target=serve, daemon=True).start()
        receiver = self.receiver()
        live = self.start(command("--camera", f"tcp://127.0.0.1:{server.getsockname()[1]}", "--mic", "none", "--lod", 1,
                                  "--send", f"jsonl://:{receiver.port}"), stderr=subprocess.PIPE, text=True)
        message = ""
        while "recovered" not in message and live.poll() is None:
            message += live.stderr.readline()
        live.send_signal(signal.SIGINT)
        message += live.communicate(timeout=60)[1]
        self.assertEqual(live.returncode, 0, message)
        self.assertRegex(message, r"tcp://127.0.0.1:\d+: .*; retrying\n")
        self.assertRegex(message, r"\d+ frames in .* s, \d+ with a face, dropped \d+ images")
        self.assertEqual(len(connections), 2)
        states = [json.loads(packet)["status"] for packet in receiver.packets()]
        self.assertIn("tracking", states)

    def test_statistics_do_not_overwrite_the_clip(self):
        shutil.copy(CLIP, self.path("clip.mp4"))
        os.symlink(self.path("clip.mp4"), self.path("stats"))
        done = run("--camera", "test:" + self.path("clip.mp4"), "--mic", "none", "--duration", 1, "--stats", self.path("stats"))
        self.assertEqual(done.returncode, 2, done.stderr)
        with open(CLIP, "rb") as clip, open(self.path("clip.mp4"), "rb") as played:
            self.assertEqual(clip.read(), played.read())

    def test_ctrl_c_before_the_first_image(self):
        """A terminal also sends it to ffmpeg, which ends with an error."""
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        live = self.start(command("--camera", f"tcp://127.0.0.1:{server.getsockname()[1]}", "--mic", "none", "--lod", 1,
                                  "--quiet", "--stats", self.path("stats")), stderr=subprocess.PIPE, text=True)
        server.settimeout(60)
        connection, _ = server.accept()  # and sends nothing
        self.addCleanup(connection.close)
        time.sleep(0.5)
        os.killpg(live.pid, signal.SIGINT)
        message = live.communicate(timeout=60)[1]
        self.assertEqual((live.returncode, message), (0, ""))
        with open(self.path("stats")) as file:
            self.assertEqual(json.load(file)["frames_with_face"], 0)

    def test_neutral_calibration_reads_a_stream_once(self):
        """The stream is opened to probe it, and once to read it, because its content cannot be repeated."""
        ffmpeg("-t", "6", "-i", CLIP, "-an", "-c", "copy", "-f", "mpegts", self.path("clip.ts"))
        with open(self.path("clip.ts"), "rb") as file:
            film = file.read()
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        opened = []

        def send(connection):
            with contextlib.suppress(OSError), connection:
                while True:
                    connection.sendall(film)

        def serve():
            with contextlib.suppress(OSError):
                while True:
                    opened.append(server.accept()[0])
                    threading.Thread(target=send, args=(opened[-1],), daemon=True).start()
        threading.Thread(target=serve, daemon=True).start()
        done = subprocess.run([PROGRAM, "neutral", f"tcp://127.0.0.1:{server.getsockname()[1]}", "-o", self.path("me"), "--models",
                               SOURCE + "/models", "--quiet"], capture_output=True, text=True, timeout=90)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(opened), 2)

    def test_failing_receivers_are_counted_and_stop_nothing(self):
        """The system rejects all packets to the first receiver, the second one starts half-way, and the third one gets all."""
        late_port, receiver = free_port(), self.receiver()
        live = self.start(command("--camera", "test:" + CLIP, "--mic", "none", "--lod", 1, "--stats", self.path("stats"),
                                  "--send", "jsonl://255.255.255.255:9999", "--send", f"jsonl://:{late_port}",
                                  "--send", f"jsonl://:{receiver.port}"), stderr=subprocess.PIPE, text=True)
        receiver.wait(lambda packets: len(packets) > 20)
        late = self.receiver(late_port)
        late.wait(lambda packets: len(packets) > 20)
        live.send_signal(signal.SIGINT)
        message = live.communicate(timeout=60)[1]
        self.assertEqual(live.returncode, 0, message)
        with open(self.path("stats")) as file:
            stats = json.load(file)
        self.assertEqual(stats["dropped_packets"], stats["frames"], "those to the first receiver")
        packets, late_packets = receiver.packets(), late.packets()
        self.assertEqual(len(packets), stats["frames"])
        self.assertLess(len(late_packets), len(packets))
        self.assertEqual(late_packets, packets[-len(late_packets):])

    def test_valid_and_invalid_hellos_of_iFacialMocap(self):
        port, stranger = free_port(), self.receiver()
        live = self.start(command("--camera", "test:" + CLIP, "--mic", "none", "--lod", 1, "--quiet", "--send", f"ifm://:{port}"))
        clients = [self.receiver(), self.receiver()]
        rng = random.Random(7)
        texts = [[], []]
        for turn in range(60):
            for _ in range(50):  # a flood of almost valid and invalid hellos
                wrong = rng.choice((b"", HELLO[:-1], HELLO.lower(), HELLO + b"x", HELLO + b"|sendDataVersion=v3", b"\0" + HELLO, HELLO + b"\0" * 9000,
                                    rng.randbytes(rng.randrange(1500)), rng.randbytes(60000)))
                stranger.socket.sendto(wrong, ("127.0.0.1", port))
            for client, hello in zip(clients, (HELLO, HELLO + b"|sendDataVersion=v2")):
                for _ in range(5):
                    client.socket.sendto(hello, ("127.0.0.1", port))
            time.sleep(0.1)
            for i, client in enumerate(clients):
                texts[i] += client.packets()
            if all(len(t) >= 10 for t in texts):
                break
        self.assertIsNone(live.poll())
        live.terminate()
        self.assertEqual(live.wait(timeout=60), 0)
        self.assertEqual(stranger.packets(), [])
        for received, separator in zip(texts, "-&"):
            self.assertGreaterEqual(len(received), 10)
            for packet in received:
                self.assertEqual(list(decode.ifacialmocap(packet, separator)["values"]), decode.IFACIALMOCAP)

    def test_standard_output(self):
        lines = f"'{PROGRAM}' live --models '{SOURCE}/models' --camera 'test:{CLIP}' --mic none --lod 1 --send - --quiet"
        head = subprocess.run(["bash", "-c", lines + " | head -2; echo ${PIPESTATUS[0]}"], capture_output=True, text=True, timeout=60)
        self.assertEqual((head.stdout.splitlines()[-1], head.stderr), ("0", ""))
        self.assertEqual(json.loads(head.stdout.splitlines()[1])["status"] in ("searching", "tracking"), True)
        # A slow reader gets few old lines, and all are complete.
        slow = self.start(["bash", "-c", lines + f" --duration 4 --stats {self.path('stats')}"], stdout=subprocess.PIPE)
        slow.wait(timeout=60)
        text = slow.stdout.read()
        slow.stdout.close()
        self.assertLessEqual(len(text), 8192)
        for line in text.splitlines():
            json.loads(line)
        with open(self.path("stats")) as file:
            self.assertGreater(json.load(file)["dropped_packets"], 10)

    def test_devices_of_ffmpeg(self):
        receiver = self.receiver()
        done = run("--camera", f"lavfi:movie='{CLIP}'", "--mic", f"lavfi:amovie='{CLIP}'", "--duration", 7, "--send", f"jsonl://:{receiver.port}")
        self.assertEqual(done.returncode, 0, done.stderr)
        frames = [json.loads(packet) for packet in receiver.packets()]
        self.assertIn("tracking", {f["status"] for f in frames})
        self.assertGreater(max(f["vad"] for f in frames), 0.5)

    def test_audio_alone_moves_the_mouth(self):
        receiver = self.receiver()
        done = run("--camera", "none", "--mic", "test:" + CLIP, "--send", f"jsonl://:{receiver.port}", "--quiet")
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        frames = [json.loads(packet) for packet in receiver.packets()]
        self.assertGreater(len(frames), 20)
        self.assertEqual({f["status"] for f in frames}, {"searching"})
        jaws = [f["controls"].get("jawOpen", 0.0) for f in frames]
        self.assertGreater(max(jaws) - min(jaws), 0.1)
        self.assertGreater(max(f["vad"] for f in frames), 0.5)

    def test_screen_and_keys(self):
        master, slave = pty.openpty()
        live = self.start(command("--camera", "test:" + CLIP, "--send", f"vmc://:{self.receiver().port}"), stdin=slave, stderr=slave)
        os.close(slave)
        seen = ""

        def until(wanted):
            nonlocal seen
            end = time.monotonic() + 30
            while not re.search(wanted, seen) and time.monotonic() < end:
                if select.select([master], [], [], 0.2)[0]:
                    try:
                        seen += os.read(master, 65536).decode()
                    except OSError:  # the other end is closed
                        break
            self.assertRegex(seen, wanted)
            seen = ""
        until(r"(?s)camera      test:.*sends to    vmc://:\d+")
        os.write(master, b"1m")
        until(r"level       1, mirrored")
        os.write(master, b"c")
        until(r"calibrating: look neutral")
        until(r"tracking    \d+\.\d ms per frame: detection \d+\.\d, face \d+\.\d, audio \d+\.\d")
        os.write(master, b"q")
        until(r"(?s)\x1b\[\?1049l.*\d+ frames in")
        self.assertEqual(live.wait(timeout=60), 0)
        os.close(master)

    def test_errors_are_named(self):
        for arguments, code, wanted in (
                (["--send", "foo://x"], 2, "unknown protocol 'foo://', supported are vmc://"),
                (["--send", "localhost"], 2, "expected a URL such as"),
                (["--send", "vmc://h:99999"], 2, "invalid port (got '99999', expected 1 to 65535)"),
                (["--send", "vmc://?names=upper"], 2, "unknown vocabulary 'upper'"),
                (["--send", "osf://?names=vrm0"], 2, "unknown option 'names' for osf"),
                (["--send", "vmc://::1"], 2, "IPv6"),
                (["--send", "jsonl://"], 2, "expected a port"),
                (["--send", "llf://?rot=gon"], 2, "got 'gon'"),
                (["--send", "llf://nowhere.invalid"], 7, "unknown host 'nowhere.invalid'"),
                (["--camera", "none", "--mic", "none"], 2, "no input to track"),
                (["--camera", "test:/nowhere.mp4"], 3, "/nowhere.mp4: no such file"),
                (["--camera", "/dev/video99", "--mic", "none"], 3, "/dev/video99: no image: "),
                (["--camera", "gopher://x", "--mic", "none"], 2, "unknown protocol 'gopher'")):
            done = run(*(arguments if "--camera" in arguments else ["--camera", "test:" + CLIP, *arguments]), text=True)
            self.assertEqual(done.returncode, code, (arguments, done.stderr))
            self.assertIn(wanted, done.stderr)

    def test_files_over_the_network(self):
        class Quiet(http.server.SimpleHTTPRequestHandler):
            def log_message(self, *_):
                pass
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SOURCE + "/tests/data"))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        track = lambda source: subprocess.run([PROGRAM, "track", source, "--models", SOURCE + "/models", "--duration", "0.5", "--quiet"],
                                              capture_output=True, text=True, timeout=120)
        there = track(f"http://127.0.0.1:{server.server_port}/demo.mp4")
        self.assertEqual(there.returncode, 0, there.stderr)
        self.assertEqual(there.stdout, track(CLIP).stdout)
        gone = track(f"http://127.0.0.1:{server.server_port}/gone.mp4")
        self.assertEqual(gone.returncode, 3)
        self.assertIn("/gone.mp4: cannot be opened", gone.stderr)
        # Network content must not lead to files of this machine.
        playlist = self.path("list.m3u8")
        with open(playlist, "w") as file:
            file.write(f"#EXTM3U\n#EXT-X-TARGETDURATION:8\n#EXTINF:8,\nfile://{CLIP}\n#EXT-X-ENDLIST\n")
        local = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=self.folder))
        threading.Thread(target=local.serve_forever, daemon=True).start()
        self.addCleanup(local.server_close)
        self.addCleanup(local.shutdown)
        self.assertNotEqual(track(f"http://127.0.0.1:{local.server_port}/list.m3u8").returncode, 0)

    def test_devices(self):
        listed = subprocess.run([PROGRAM, "devices", "--json"], capture_output=True, text=True, timeout=60)
        self.assertEqual(listed.returncode, 0, listed.stderr)
        for device in json.loads(listed.stdout):
            self.assertEqual(list(device), ["kind", "name", "description"])


if __name__ == "__main__":
    if not shutil.which("ffmpeg") or not os.path.exists(SOURCE + "/models/basenet.mien"):
        print("skipped: ffmpeg or the weights are missing")
        sys.exit(77)
    unittest.main()
