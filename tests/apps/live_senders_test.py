"""Tests of `mien live` with VTube Studio's plugin API and VRChat's OSC.

usage: live_senders_test.py MIEN_PROGRAM SOURCE_FOLDER
"""
import json
import os
import queue
import re
import shutil
import socket
import stat
import struct
import subprocess
import tempfile
import threading
import time
import unittest

import avatar_values
import fake_vts
import live_packets as decode
from datagrams import Receiver
from fake_vts import BINARY, CLOSE, PATIENCE, PING, PONG, TEXT, FakeVts
from live_page import Live, Shared, arguments

NO_INPUT = ("--camera", "none", "--mic", "none")  # frames without a face


def detail(state):
    return state["senders"][0]["detail"]


class Vts(unittest.TestCase):
    """The connection to VTube Studio."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.token = os.path.join(self.folder, "token")

    def url(self, server):
        return f"vts://127.0.0.1:{server.port}?token={self.token}"

    def start(self, server, *inputs):
        return self.enterContext(Live(*(inputs or NO_INPUT), "--send", self.url(server)))

    def await_state(self, live, pattern):
        return live.state(lambda state: re.search(pattern, detail(state)))

    def keep_token(self, token):
        with open(self.token, "w") as file:
            file.write(token + "\n")

    def kept_token(self):
        with open(self.token) as file:
            return file.read()

    def test_asks_the_user_once_and_keeps_the_token(self):
        allowed = threading.Event()

        class Patient(FakeVts):
            def ask_user(self, connection, message):
                allowed.wait(PATIENCE)
                super().ask_user(connection, message)
        with Patient() as server:
            live = self.start(server)
            self.await_state(live, "^waiting for permission in VTube Studio$")
            self.assertFalse(os.path.exists(self.token))
            asked = server.request("AuthenticationTokenRequest")
            self.assertTrue(3 <= len(asked["pluginName"]) <= 32 and 3 <= len(asked["pluginDeveloper"]) <= 32)
            allowed.set()
            self.await_state(live, "^connected$")
            self.assertEqual(self.kept_token(), "issued-token-1\n")
            self.assertEqual(stat.S_IMODE(os.stat(self.token).st_mode), 0o600)
            self.assertEqual(server.request("AuthenticationRequest"), {**asked, "authenticationToken": "issued-token-1"})
            for name in avatar_values.CUSTOM:
                creation = server.request("ParameterCreationRequest")
                self.assertEqual({key: creation[key] for key in ("parameterName", "min", "max", "defaultValue")},
                                 {"parameterName": name, "min": 0, "max": 1, "defaultValue": 0})
                self.assertLess(len(creation["explanation"]), 256)

    def test_reconnects_when_vts_restarts(self):
        with FakeVts() as first:
            live = self.start(first)
            self.await_state(live, "^connected$")
            first.close()
        self.await_state(live, "^not connected: .*retrying$")
        with FakeVts(port=first.port) as second:
            self.await_state(live, "^connected$")
            self.assertEqual([second.requests.get(timeout=PATIENCE)[0] for _ in range(2)], ["APIStateRequest", "AuthenticationRequest"])
        self.assertEqual(live.stop(), 0)

    def test_waits_for_vts_to_start(self):
        with FakeVts() as server:
            port = server.port
        live = self.enterContext(Live(*NO_INPUT, "--send", f"vts://:{port}?token={self.token}"))
        self.await_state(live, "^not connected: Connection refused; retrying$")
        with FakeVts(port=port):
            self.await_state(live, "^connected$")

    def test_a_rejected_token_is_replaced(self):
        self.keep_token("old-token")
        with FakeVts() as server:
            self.await_state(self.start(server), "^connected$")
            self.assertEqual(server.request("AuthenticationRequest")["authenticationToken"], "old-token")
            server.request("AuthenticationTokenRequest")
            self.assertEqual(server.request("AuthenticationRequest")["authenticationToken"], "issued-token-1")
        self.assertEqual(self.kept_token(), "issued-token-1\n")

    def test_asks_only_once_if_every_token_is_rejected(self):
        self.keep_token("old-token")
        with FakeVts() as server:
            server.issued = "another-token"
            live = self.start(server)
            self.await_state(live, "^refused: Token invalid.$")
            self.assertEqual([server.requests.get(timeout=PATIENCE)[0] for _ in range(4)],
                             ["APIStateRequest", "AuthenticationRequest", "AuthenticationTokenRequest", "AuthenticationRequest"])
            self.frames(live, 20)
            self.assertTrue(server.requests.empty())

    def frames(self, live, count):
        """Waits for this number of frames."""
        first = live.events(lambda name, _: name == "frame")["n"]
        live.events(lambda name, data: name == "frame" and data["n"] >= first + count)

    def test_a_denied_permission_is_shown_and_not_asked_for_again(self):
        class Denying(FakeVts):
            def ask_user(self, connection, message):
                connection.error(message, 50, "User has denied API access for your plugin.")
        with Denying() as server:
            live = self.start(server)
            self.await_state(live, "^refused: User has denied API access for your plugin.$")
            self.frames(live, 20)
            self.assertEqual([server.requests.get()[0] for _ in range(server.requests.qsize())], ["APIStateRequest", "AuthenticationTokenRequest"])
        self.assertFalse(os.path.exists(self.token))

    def test_asks_again_while_vts_asks_for_another_connection(self):
        class Busy(FakeVts):
            asked = 0

            def ask_user(self, connection, message):
                self.asked += 1
                if self.asked == 1:
                    connection.error(message, 51, "Token request currently ongoing.")
                else:
                    super().ask_user(connection, message)
        with Busy() as server:
            self.await_state(self.start(server), "^connected$")
            self.assertEqual(server.asked, 2)

    def test_a_file_that_cannot_be_written_does_not_stop_the_program(self):
        self.token += "/in/no/folder"
        with FakeVts() as server:
            self.await_state(self.start(server), "^connected; .*/token/in/no/folder")

    def test_invalid_servers_are_left_and_tried_again(self):
        text = lambda payload: lambda c: (c.accept(), c.send_frame(TEXT, payload))
        raw = lambda payload: lambda c: (c.accept(), c.client.sendall(payload))
        answer = lambda kind, data: lambda c: (c.accept(), c.answer(c.message(), kind, data))
        faults = [
            ("not a WebSocket server", lambda c: (c.request(), c.accept("AAAAAAAAAAAAAAAAAAAAAA=="))),
            ("HTTP status 403", lambda c: (c.request(), c.client.sendall(b"HTTP/1.1 403 Forbidden\r\n\r\n"))),
            ("not an HTTP response", lambda c: (c.request(), c.client.sendall(b"SSH-2.0-x\r\n\r\n"))),
            ("not an HTTP response", lambda c: (c.request(), c.client.sendall(b"HTTP/1.1 101 x\r\nA: " + b"a" * 10000))),
            ("extension", lambda c: c.accept(extra="Sec-WebSocket-Extensions: permessage-deflate\r\n")),
            ("closed by the server", lambda c: c.request()),
            ("closed by the server", lambda c: (c.request(), c.client.sendall(b"HTTP/1.1 101 Swi"), c.client.shutdown(socket.SHUT_WR))),
            ("closed by the server", lambda c: (c.accept(), c.message())),
            ("closed by the server", lambda c: (c.accept(), c.send_frame(CLOSE, b"\x03\xe8"))),
            ("larger than 1 MiB", raw(b"\x81\x7f" + struct.pack(">Q", (1 << 20) + 1))),
            ("larger than 1 MiB", raw(b"\x81\x7f" + b"\xff" * 8)),
            ("larger than 1 MiB", raw((b"\x01\x7e\xff\xff" + b" " * 65535) + (b"\x00\x7e\xff\xff" + b" " * 65535) * 16)),
            ("reserved bits or a mask", lambda c: (c.accept(), c.send_frame(TEXT, b"{}", mask=128))),
            ("reserved bits or a mask", raw(b"\xc1\x02{}")),
            ("unknown opcode", raw(b"\x83\x00")),
            ("wrong order of fragments", raw(b"\x80\x00")),
            ("fragmented or long control frame", raw(b"\x09\x00")),
            ("binary message", lambda c: (c.accept(), c.send_frame(BINARY, b"{}"))),
            ("invalid JSON", text(b"{")),
            ("invalid JSON", text(b"\xff\xfe")),
            ("invalid JSON", text(b"[" * 60000)),
            ("not from VTube Studio", text(b"[1, 2]")),
            ("not from VTube Studio", text(b'{"apiName": 3}')),
            ("invalid token", lambda c: (c.accept(), c.answer(c.message(), "APIStateResponse", {}),
                                         c.answer(c.message(), "AuthenticationTokenResponse", {"authenticationToken": "a\nb"}))),
            ("no answer", lambda c: (c.accept(), c.message(), c.frame())),
        ]
        live, server = None, None
        done, turn = queue.Queue(), iter(faults)

        def behave(connection):
            fault = next(turn, None)
            if fault is None:
                server.serve(connection)
            try:
                fault[1](connection)
                while fault[0] != "closed by the server" and connection.client.recv(65536):
                    pass
            except (OSError, fake_vts.Closed):
                pass
            done.put(fault[0])
        with FakeVts(behave) as server:
            live = self.start(server)
            for expected, _ in faults:
                self.assertEqual(done.get(timeout=PATIENCE), expected)
                self.await_state(live, "^not connected: .*" + expected + ".*; retrying$")
            self.await_state(live, "^connected$")
        self.assertIsNone(live.process.poll())

    def test_unexpected_answers_are_ignored(self):
        class Talkative(FakeVts):
            def ask_user(self, connection, message):
                for kind, data in (("ModelLoadedEvent", {}), ("APIStateResponse", {}), ("AuthenticationResponse", {"authenticated": True}), (3, None),
                                   ("InjectParameterDataResponse", {}), ("ParameterCreationResponse", {}), ("APIError", 4)):
                    connection.answer(dict(message, requestID="x" * 64), kind, data)
                super().ask_user(connection, message)
        with Talkative() as server:
            live = self.start(server)
            self.await_state(live, "^refused: $|^connected$")

    def test_fragments_and_pings(self):
        pongs = queue.Queue()

        def behave(connection):
            connection.accept()
            message = connection.message()
            text = json.dumps({"apiName": "VTubeStudioPublicAPI", "messageType": "APIStateResponse", "requestID": message["requestID"]}).encode()
            connection.send_frame(TEXT, text[:10], final=False)
            connection.send_frame(PING, b"are you there")
            connection.send_frame(0, text[10:11], final=False)
            pongs.put(connection.frame())
            connection.send_frame(PONG, b"unasked")
            for byte in bytes([0x80, len(text) - 11]) + text[11:]:
                connection.client.sendall(bytes([byte]))
            authenticated = False
            while True:
                authenticated = server.reply(connection, connection.message(), authenticated) or authenticated
        with FakeVts(behave) as server:
            self.await_state(self.start(server), "^connected$")
            self.assertEqual(pongs.get(timeout=PATIENCE), (PONG, b"are you there"))

    def test_wrong_arguments(self):
        with open(self.token, "w") as file:
            file.write("two words\n")
        for destination, code, message in ((f"vts://?token={self.token}", 3, "not a token of VTube Studio"), ("vts://?tokens=x", 2, "unknown option 'tokens'"),
                                           ("vts://no.such.host.invalid", 7, "unknown host"), ("vrchat://?eyes=left", 2, "eyes: expected native or none"),
                                           ("vrchat://?prefix=a*b", 2, "prefix: contains a character")):
            done = subprocess.run(arguments(*NO_INPUT, "--send", destination), capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(message, done.stderr)
        environment = {name: value for name, value in os.environ.items() if name not in ("HOME", "XDG_CONFIG_HOME")}
        done = subprocess.run(arguments(*NO_INPUT, "--send", "vts://"), capture_output=True, text=True, timeout=PATIENCE, env=environment)
        self.assertEqual((done.returncode, "no folder for settings" in done.stderr), (2, True), done.stderr)

    def test_the_default_file_is_in_the_configuration_folder(self):
        environment = dict(os.environ, XDG_CONFIG_HOME=self.folder)
        with FakeVts() as server:
            process = subprocess.Popen(arguments(*NO_INPUT, "--send", f"vts://:{server.port}"), stderr=subprocess.DEVNULL, env=environment)
            self.addCleanup(process.wait)
            self.addCleanup(process.kill)
            server.request("ParameterCreationRequest")
            with open(os.path.join(self.folder, "mien", "vts-token")) as file:
                self.assertEqual(file.read(), "issued-token-1\n")


class Values(Shared):
    """What receivers get while a face is tracked."""

    def send(self, destination):
        """A run that also sends JSON lines, to compare with."""
        receiver = self.enterContext(Receiver())
        live = self.live("--mic", "none", "--lod", 1, "--send", destination, "--send", f"jsonl://127.0.0.1:{receiver.port}")
        return live, receiver

    def vts(self, server):
        return self.send(f"vts://127.0.0.1:{server.port}?token={self.path('token' + str(server.port))}")

    def test_vts_gets_the_values_of_other_receivers(self):
        with FakeVts() as server:
            _, receiver = self.vts(server)
            deadline = time.monotonic() + PATIENCE
            while time.monotonic() < deadline:  # until the custom parameters exist
                data = server.injections.get(timeout=PATIENCE)
                if any(self.same_values(data, frame) for frame in map(json.loads, list(receiver.kept))):
                    break
            else:
                self.fail(f"{data} equals no frame")
            self.assertEqual(data["mode"], "set")
            self.assertLessEqual({value["id"] for value in data["parameterValues"] if value["id"].startswith("Mien")}, server.created)

    def same_values(self, data, frame):
        got = {value["id"]: value["value"] for value in data["parameterValues"]}
        wanted = avatar_values.vts(frame)
        return got.keys() == wanted.keys() and all(abs(got[name] - wanted[name]) < 1e-9 for name in got) and (
            data["faceFound"] == (frame["status"] == "tracking"))

    def test_a_slow_vts_does_not_delay_others(self):
        class Silent(FakeVts):
            def inject(self, connection, message, authenticated):
                self.injections.put(message["data"])
        with Silent() as server:
            live, receiver = self.vts(server)
            server.injections.get(timeout=PATIENCE)
            live.state(lambda state: state["dropped_packets"] >= 3)
            self.assertEqual(server.injections.qsize(), 3)  # 4 without an answer
            count = len(receiver.kept)
            receiver.wait(lambda packets: len(packets) >= count + 3)
            live.state(lambda state: detail(state).startswith("not connected: no answer"))

    def test_errors_of_vts_are_shown_until_the_next_success(self):
        class Moody(FakeVts):
            error = True

            def inject(self, connection, message, authenticated):
                if self.error:
                    connection.error(message, 454, "controlled by other plugin")
                else:
                    super().inject(connection, message, authenticated)
        with Moody() as server:
            live, _ = self.vts(server)
            live.state(lambda state: detail(state) == "connected; controlled by other plugin")
            server.error = False
            live.state(lambda state: detail(state) == "connected")

    def test_a_withdrawn_permission_is_asked_for_again(self):
        class Withdrawing(FakeVts):
            injected = 0

            def inject(self, connection, message, authenticated):
                self.injected += 1
                if self.injected == 1:
                    self.valid_tokens, self.issued = {"issued-token-2"}, "issued-token-2"
                    connection.error(message, 8, "This request requires authentication.")
                else:
                    super().inject(connection, message, authenticated)
        with Withdrawing() as server:
            self.vts(server)
            server.injections.get(timeout=PATIENCE)
            used = [server.request("AuthenticationRequest")["authenticationToken"] for _ in range(3)]
            self.assertEqual(used, ["issued-token-1", "issued-token-1", "issued-token-2"])

    def test_a_paused_destination_gets_nothing(self):
        with FakeVts() as server:
            live, receiver = self.vts(server)
            server.injections.get(timeout=PATIENCE)
            live.command("sender", sender=0, paused=True)
            live.state(lambda state: state["senders"][0]["paused"])
            while not server.injections.empty():
                server.injections.get()
            count = len(receiver.kept)
            receiver.wait(lambda packets: len(packets) >= count + 5)
            self.assertLessEqual(server.injections.qsize(), 4)  # those that were on their way

    def test_vrchat_gets_the_values_of_other_receivers(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as osc:
            osc.bind(("127.0.0.1", 0))
            osc.settimeout(PATIENCE)
            osc.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
            _, receiver = self.send(f"vrchat://127.0.0.1:{osc.getsockname()[1]}")
            first = b"/avatar/parameters/EyeTrackingActive\0"
            deadline, got = time.monotonic() + PATIENCE, {"native": {}}
            bundles = []
            while not got["native"] and time.monotonic() < deadline:
                packet = osc.recv(65536)
                if first in packet and bundles:
                    got, bundles = decode.vrchat(bundles), []
                bundles.append(packet)

            def same(frame):
                wanted, native = avatar_values.vrchat(frame), avatar_values.native_eyes(frame)
                return (got["parameters"].keys() == wanted.keys() and all(abs(got["parameters"][name] - wanted[name]) < 1e-6 for name in wanted) and
                        all(abs(a - b) < 1e-5 for name in native for a, b in zip(got["native"][name], native[name], strict=True)))
            self.assertEqual(got["active"], [True] * 3)
            self.assertGreater(len(got["parameters"]), 20)
            receiver.wait(lambda packets: any(same(json.loads(packet)) for packet in packets))


if __name__ == "__main__":
    unittest.main()
