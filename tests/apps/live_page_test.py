"""Tests of the web server of `mien live --page`: access, and its commands.

usage: live_page_test.py MIEN_PROGRAM SOURCE_FOLDER
"""
import contextlib
import http.client
import json
import os
import socket
import struct
import subprocess
import unittest

from datagrams import Receiver
from live_page import CLIP, JSON, PROGRAM, SOURCE, Live, Shared, arguments


def frame_number(packet):
    return json.loads(packet)["frame"]


class Access(Shared):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.server = cls.enterClassContext(Live("--camera", cls.clip, "--mic", "none"))

    def test_without_the_token_everything_is_forbidden_and_empty(self):
        wrong = "/" + "0" * 32 + "/"
        for target in ("/", "/obs", "/events", "/preview", "/favicon.ico", wrong, wrong + "obs", self.server.path[:-1], self.server.path[:-2] + "/",
                       "/" + self.server.path, "/x/.." + self.server.path, "/?" + self.server.path):
            for method in ("GET", "POST", "PUT"):
                self.assertEqual(self.server.request(target, method), (403, b""), target)

    def test_other_hosts_and_origins_are_forbidden(self):
        port = self.server.port
        for headers in ({"Host": "example.com"}, {"Host": f"example.com:{port}"}, {"Host": "127.0.0.1"}, {"Host": f"127.0.0.1:{port + 1}"},
                        {"Host": f"127.0.0.1:{port}.example.com"}, {"Origin": "http://example.com"}, {"Origin": "null"},
                        {"Origin": f"https://127.0.0.1:{port}"}, {"Origin": f"http://127.0.0.1:{port}.example.com"}):
            self.assertEqual(self.server.request(self.server.path, headers=headers), (403, b""), headers)
        for headers in ({"Host": f"localhost:{port}"}, {"Origin": f"http://127.0.0.1:{port}"}, {"Origin": f"http://localhost:{port}"}):
            self.assertEqual(self.server.request(self.server.path, headers=headers)[0], 200, headers)

    def test_listens_on_loopback_only(self):
        rows = []
        for table in ("/proc/net/tcp", "/proc/net/tcp6"):
            with contextlib.suppress(FileNotFoundError), open(table) as file:
                rows += [line.split() for line in file.readlines()[1:]]
        ours = [row[1].split(":")[0] for row in rows if row[3] == "0A" and int(row[1].split(":")[1], 16) == self.server.port]
        self.assertEqual(ours, ["0100007F"])

    def test_tokens_differ(self):
        other = self.enterContext(Live("--camera", "none", "--mic", "none"))
        self.assertNotEqual(other.path, self.server.path)

    def test_paths_are_exact(self):
        for page in ("..", "../", "obs/", "OBS", "obs/..", "%6fbs", "obs%00", "../../etc/passwd", "%2e%2e/x", "//obs", "page.js", "?x"):
            status, body = self.server.get(page)
            self.assertEqual((status, body), (404, b""), page)

    def test_responses_are_neither_stored_nor_framed(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=60)
        with contextlib.closing(connection):
            connection.request("GET", self.server.path)
            response = connection.getresponse()
            response.read()
        self.assertEqual(response.headers["Cache-Control"], "no-store")
        self.assertEqual(response.headers["Referrer-Policy"], "no-referrer")
        self.assertEqual(response.headers["X-Frame-Options"], "DENY")
        self.assertIsNone(response.headers["Access-Control-Allow-Origin"])

    def test_malformed_requests(self):
        host = f"Host: 127.0.0.1:{self.server.port}\r\n".encode()
        path = self.server.path.encode()
        post = b"POST " + path + b"command HTTP/1.1\r\n" + host
        cases = {b"\r\n\r\n": 400, b"GET\r\n\r\n": 400, b"GET / HTTP/9.9\r\n" + host + b"\r\n": 505, b"\x16\x03\x01\x02\x00\r\n\r\n": 400,
                 b"GET / HTTP/1.1\r\n\r\n": 400, b"GET / HTTP/1.1\r\n" + host + host + b"\r\n": 400,
                 b"GET http://127.0.0.1/ HTTP/1.1\r\n" + host + b"\r\n": 400, b"GET / HTTP/1.1\n" + host + b"\r\n\r\n": 400,
                 b"GET / HTTP/1.1\r\n" + host + b" folded: x\r\n\r\n": 400, b"GET / HTTP/1.1\r\n" + b"a: b\r\n" * 65 + b"\r\n": 431,
                 b"GET /" + b"a" * 9000 + b" HTTP/1.1\r\n" + host + b"\r\n": 431, post + b"Content-Length: x\r\n\r\n": 400,
                 post + b"Content-Length: -1\r\n\r\n": 400, post + b"Content-Length: 99999999999999999999\r\n\r\n": 400,
                 post + b"Content-Length: 1\r\nContent-Length: 1\r\n\r\nx": 400, post + b"Content-Length: 16385\r\n\r\n": 413,
                 post + b"Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n": 501}
        for data, status in cases.items():
            answer = self.server.raw(data)
            self.assertTrue(answer.startswith(b"HTTP/1.1 %d " % status), (data[:80], answer[:80]))
            self.assertTrue(answer.endswith(b"\r\n\r\n"), data[:80])  # no body
        self.assertEqual(self.server.raw(b"GET / HT"), b"")  # incomplete
        self.assertEqual(self.server.get("")[0], 200)

    def test_a_connection_serves_several_requests(self):
        head = f"GET {self.server.path}devices HTTP/1.1\r\nHost: 127.0.0.1:{self.server.port}\r\n\r\n".encode()
        self.assertEqual(self.server.raw(head * 3).count(b"HTTP/1.1 200 OK"), 3)

    def test_slow_and_idle_clients_are_dropped_and_do_not_block_others(self):
        with contextlib.ExitStack() as stack:
            clients = [stack.enter_context(socket.create_connection(("127.0.0.1", self.server.port), timeout=60)) for _ in range(40)]
            for client in clients:
                with contextlib.suppress(OSError):
                    client.sendall(b"GET / HTTP/1.1\r\n")
            for client in clients:
                with contextlib.suppress(ConnectionResetError):
                    while client.recv(4096):
                        pass
        self.assertEqual(self.server.get("")[0], 200)

    def test_wrong_commands(self):
        for body, fault in (("", b"not a JSON object"), ("[]", b"not a JSON object"), ("{", b"not a JSON object"), ("{}", b"do: expected a known command"),
                            ('{"do":"quit"}', b"do: expected a known command"), ('{"do":"level","level":5}', b"level: expected 0 to 4"),
                            ('{"do":"level","level":1.5}', b"level: expected 0 to 4"), ('{"do":"mirror","on":1}', b"on: expected true or false"),
                            ('{"do":"sender","sender":-1,"paused":true}', b"sender: expected a number"),
                            ('{"do":"adjust","controls":[{"control":"nose"}]}', b"control: unknown name (got 'nose')"),
                            ('{"do":"adjust","controls":[{"control":"jawOpen","gain":5}]}', b"gain: out of range (got 5, expected 0 to 4.0)"),
                            ('{"do":"adjust","controls":[{"control":"jawOpen","dead_zone":1}]}', b"dead_zone: out of range (got 1, expected 0 to 0.9)"),
                            ("[" * 16000, b"not a JSON object")):
            self.assertEqual(self.server.request(self.server.path + "command", "POST", body, JSON), (400, fault), body[:80])
        self.assertEqual(self.server.request(self.server.path + "command", "POST", '{"do":"save"}', {"Content-Type": "text/plain"})[0], 415)
        self.assertEqual(self.server.request(self.server.path, "PUT")[0], 405)

    def test_the_page_opens_devices_of_this_machine_only(self):
        for name in ("lavfi:testsrc", "http://example.com/x", "test:/etc/passwd", "/etc/passwd", ""):
            for kind in ("camera", "microphone"):
                self.assertEqual(self.server.command(kind, name=name), (400, b"name: not a device of this machine"))


class Control(Shared):
    def test_the_preview_is_an_image_of_the_camera(self):
        live = self.live("--mic", "none")
        status, image = live.preview()
        self.assertEqual(status, 200)
        width, height = struct.unpack_from("<ii", image, 18)
        self.assertEqual((image[:2], max(width, height), len(image)), (b"BM", 320, 54 + width * height * 3))
        frame = subprocess.run(["ffmpeg", "-v", "error", "-f", "bmp_pipe", "-i", "-", "-f", "rawvideo", "-pix_fmt", "gray", "-"], input=image,
                               capture_output=True, check=True).stdout
        expected = subprocess.run(["ffmpeg", "-v", "error", "-i", CLIP, "-frames:v", "1", "-vf", f"scale={width}:{height}:flags=area", "-f",
                                   "rawvideo", "-pix_fmt", "gray", "-"], capture_output=True, check=True).stdout
        apart = sum(abs(a - b) for a, b in zip(frame, expected, strict=True)) / len(frame)
        self.assertLess(apart, 20)  # the head moves

    def test_frames_are_those_of_the_senders(self):
        with Receiver() as receiver:
            live = self.live("--send", f"jsonl://:{receiver.port}")
            live.command("mirror", on=True)
            live.command("adjust", controls=[{"control": "jawOpen", "gain": 2, "dead_zone": 0.1}])
            live.state(lambda state: state["mirrored"] and state["adjustments"][17] == [2.0, 0.1])
            frame = live.events(lambda name, data: name == "frame" and data["status"] == "tracking" and data["raw"][17] > 0.15)
            packets = receiver.wait(lambda packets: packets and frame_number(packets[-1]) >= frame["n"])
        packet = next(p for p in map(json.loads, packets) if p["frame"] == frame["n"])
        names = list(packet["controls"])
        driven = [value for value in frame["controls"] if value is not None]
        self.assertEqual(len(names), len(driven))
        for value, name in zip(driven, names, strict=True):
            self.assertAlmostEqual(packet["controls"][name], value, delta=1e-4)
        self.assertAlmostEqual(frame["controls"][17], min(1, 2 * (frame["raw"][17] - 0.1) / 0.9), delta=1e-3)
        self.assertAlmostEqual(frame["controls"][0], frame["raw"][7], delta=1e-4)  # eyeBlinkLeft, mirrored

    def test_senders_pause(self):
        with Receiver() as receiver:
            live = self.live("--mic", "none", "--send", f"jsonl://:{receiver.port}")
            receiver.wait()
            live.command("sender", sender=0, paused=True)
            live.state(lambda state: state["senders"][0]["paused"])
            first = live.events(lambda name, data: name == "frame")["n"]
            last = live.events(lambda name, data: name == "frame" and data["n"] >= first + 10)["n"]
            live.command("sender", sender=0, paused=False)
            live.command("sender", sender=7, paused=True)  # no such sender
            sent = [frame_number(packet) for packet in receiver.wait(lambda packets: packets and frame_number(packets[-1]) > last)]
        self.assertEqual([n for n in sent if first < n <= last], [])

    def test_a_profile_is_saved_and_loaded(self):
        profile = self.path("me.json")
        live = self.live("--profile", profile)
        live.events(lambda name, data: name == "frame" and data["status"] == "tracking")
        live.state(lambda state: state["calibrating"], command="neutral")
        live.state(lambda state: not state["calibrating"])
        live.command("adjust", controls=[{"control": "jawOpen", "gain": 1.5, "dead_zone": 0.05}, {"control": "cheekPuff", "gain": 0}])
        live.command("save")
        live.state(lambda state: state["saved"] == 1)
        self.assertEqual(live.stop(), 0)
        with open(profile) as file:
            saved = json.load(file)
        self.assertEqual(saved["mien_profile"], 1)
        self.assertEqual(saved["controls"], [{"control": "jawOpen", "gain": 1.5, "dead_zone": 0.05},
                                             {"control": "cheekPuff", "gain": 0.0, "dead_zone": 0.0}])
        self.assertIn("neutral", saved)
        again = self.live("--profile", profile)
        state = again.state()
        self.assertEqual((state["adjustments"][17], state["profile_file"]), ([1.5, 0.05], profile))
        lines = subprocess.run([PROGRAM, "live", "--models", SOURCE + "/models", "--camera", "test:" + CLIP, "--mic", "none", "--profile", profile,
                                "--send", "-", "--quiet", "--duration", "2"], capture_output=True, timeout=60, check=True).stdout.splitlines()
        self.assertTrue(all(json.loads(line)["controls"].get("cheekPuff", 0) == 0 for line in lines))

    def test_without_a_file_the_profile_is_offered(self):
        live = self.live("--mic", "none")
        self.assertEqual(live.get("profile")[0], 404)
        live.command("save")
        live.state(lambda state: state["saved"] == 1)
        self.assertEqual(json.loads(live.get("profile")[1]), {"mien_profile": 1, "controls": []})

    def test_wrong_profiles(self):
        for text, fault in (("{}", "not a profile"), ("x", "not a profile"), ('{"mien_profile":2}', "mien_profile: unknown version (expected 1)"),
                            ('{"mien_profile":1,"neutral":"AAAA"}', "neutral: not a neutral file in base64"),
                            ('{"mien_profile":1,"controls":{}}', "controls: not an array"),
                            ('{"mien_profile":1,"controls":[{"gain":1}]}', "control: missing"),
                            ('{"mien_profile":1,"controls":[{"control":"jawOpen","gain":"1"}]}', 'gain: out of range (got "1", expected 0 to 4.0)')):
            with open(self.path("wrong.json"), "w") as file:
                file.write(text)
            done = subprocess.run(arguments("--camera", self.clip, "--profile", self.path("wrong.json")), capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (3, f"mien: {self.path('wrong.json')}: {fault}\n"))
        done = subprocess.run([PROGRAM, "live", "--camera", self.clip, "--profile", self.path("absent.json")], capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 3)  # without --page it must exist

    def test_a_missing_camera_is_explained_and_retried(self):
        live = self.enterContext(Live("--camera", "/dev/video77", "--mic", "none"))
        state = live.state(lambda state: state["camera"]["error"])
        self.assertIn("connect a camera, or choose one", state["camera"]["error"])
        self.assertEqual(live.command("camera", name="none")[0], 204)
        live.state(lambda state: state["camera"] == {"name": "none", "error": ""})
        self.assertEqual(live.command("camera", name="/dev/video77")[0], 204)
        live.state(lambda state: state["camera"]["name"] == "/dev/video77")

    def test_without_ffmpeg_the_program_says_what_to_do(self):
        done = subprocess.run(arguments("--camera", "/dev/video0", "--mic", "none"), capture_output=True, text=True, timeout=60, env={"PATH": "/nonexistent"})
        self.assertEqual(done.returncode, 6)
        self.assertEqual(done.stderr.splitlines()[-1], "mien: cannot run 'ffmpeg': not on PATH; install ffmpeg, for example with "
                         "`apt install ffmpeg`, `brew install ffmpeg` or `winget install ffmpeg`")

    def test_a_port_can_be_chosen_and_is_free_again_after_the_program(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        for _ in range(2):
            with Live(port, "--camera", self.clip, "--mic", "none") as live:
                self.assertEqual(live.port, port)
                self.assertEqual(live.get("obs")[0], 200)
                done = subprocess.run(arguments(port, "--camera", self.clip), capture_output=True, text=True, timeout=60)
                self.assertEqual(done.returncode, 7)
                self.assertIn(f"--page: cannot listen on port {port} of 127.0.0.1", done.stderr)
                live.events()
                self.assertEqual(live.stop(), 0)

    def test_a_token_can_be_kept(self):
        token = self.path("token")
        with Live("--camera", "none", "--page-token", token) as first:
            self.assertEqual(os.stat(token).st_mode & 0o777, 0o600)
        with Live("--camera", "none", "--page-token", token) as second:
            self.assertEqual(second.path, first.path)
            self.assertEqual(second.get("")[0], 200)
        for text in ("", "0" * 31, "0" * 33, "0" * 31 + "/", "0" * 31 + "A"):
            with open(token, "w") as file:
                file.write(text)
            done = subprocess.run(arguments("--camera", "none", "--page-token", token), capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr),
                             (3, f"mien: --page-token {token}: not a token (expected 32 hexadecimal digits in lower case)\n"))
        done = subprocess.run(arguments("--page-token", self.path("no/folder")), capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 7)
        done = subprocess.run([PROGRAM, "live", "--page-token", token], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)  # needs --page

    def test_a_token_does_not_follow_a_prepared_link(self):
        link, target = self.path("link"), self.path("target")
        os.symlink(target, link)
        with Live("--camera", "none", "--page-token", link):
            self.assertFalse(os.path.exists(target))
            self.assertFalse(os.path.islink(link))

    def test_ctrl_c_ends_the_program_while_clients_listen(self):
        live = self.live("--mic", "none")
        with contextlib.ExitStack() as stack:
            for target in ("events", "events", "preview", "obs"):
                client = stack.enter_context(socket.create_connection(("127.0.0.1", live.port), timeout=60))
                client.sendall(f"GET {live.path}{target} HTTP/1.1\r\nHost: 127.0.0.1:{live.port}\r\n\r\n".encode())
                client.recv(64)
            self.assertEqual(live.stop(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
