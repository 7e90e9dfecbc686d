"""A server that behaves as VTube Studio's plugin API does, or as a test wants."""
import base64
import contextlib
import hashlib
import json
import queue
import socket
import struct
import threading

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10
PATIENCE = 60  # seconds


class Closed(Exception):
    """The client has closed the connection."""


class Connection:
    """One client. Its frames must be masked, as RFC 6455 requires."""

    def __init__(self, client):
        self.client, self.buffer = client, b""

    def fill(self):
        part = self.client.recv(65536)
        if not part:
            raise Closed
        self.buffer += part

    def take(self, count):
        while len(self.buffer) < count:
            self.fill()
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def request(self):
        """The fields of the client's handshake"""
        while b"\r\n\r\n" not in self.buffer:
            self.fill()
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        first, *lines = head.decode().split("\r\n")
        fields = dict(line.split(": ", 1) for line in lines)
        if (first, fields["Upgrade"], fields["Connection"], fields["Sec-WebSocket-Version"]) != ("GET / HTTP/1.1", "websocket", "Upgrade", "13"):
            raise ValueError(head)
        if len(base64.b64decode(fields["Sec-WebSocket-Key"], validate=True)) != 16:
            raise ValueError(head)
        return fields

    def accept(self, key=None, extra=""):
        key = key or self.request()["Sec-WebSocket-Key"]
        digest = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()
        self.client.sendall(("HTTP/1.1 101 Switching Protocols\r\nupgrade: WebSocket\r\nConnection: keep-alive, Upgrade\r\n"
                             f"Sec-WebSocket-Accept: {base64.b64encode(digest).decode()}\r\n{extra}\r\n").encode())

    def frame(self):
        first, second = self.take(2)
        size = second & 127
        if size == 126:
            size, = struct.unpack(">H", self.take(2))
        elif size == 127:
            size, = struct.unpack(">Q", self.take(8))
        if not first & 128 or first & 112 or not second & 128:
            raise ValueError("not a whole masked frame")
        mask, payload = self.take(4), self.take(size)
        return first & 15, bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))

    def message(self):
        """The next request; answers to pings are skipped."""
        while True:
            opcode, payload = self.frame()
            if opcode == CLOSE:
                raise Closed
            if opcode == TEXT:
                message = json.loads(payload)
                if (message["apiName"], message["apiVersion"]) != ("VTubeStudioPublicAPI", "1.0") or not 1 <= len(message["requestID"]) <= 64:
                    raise ValueError(payload)
                return message

    def send_frame(self, opcode, payload, final=True, mask=0):
        size = len(payload)
        length = bytes([mask | size]) if size < 126 else bytes([mask | 126]) + struct.pack(">H", size)
        self.client.sendall(bytes([(128 if final else 0) | opcode]) + length + payload)

    def answer(self, message, kind, data):
        text = json.dumps({"apiName": "VTubeStudioPublicAPI", "apiVersion": "1.0", "timestamp": 1, "messageType": kind,
                           "requestID": message["requestID"], "data": data})
        self.send_frame(TEXT, text.encode())

    def error(self, message, number, text):
        self.answer(message, "APIError", {"errorID": number, "message": text})


class FakeVts:
    """Listens on this machine. `behave(connection)` handles each client; the default is an agreeable VTube Studio."""

    def __init__(self, behave=None, port=0):
        self.behave = behave or self.serve
        self.listener = socket.create_server(("127.0.0.1", port))
        self.port = self.listener.getsockname()[1]
        self.requests = queue.Queue()  # (type, data) of all requests except injections
        self.injections = queue.Queue()
        self.valid_tokens, self.created, self.failures, self.clients = {"issued-token-1"}, set(), [], []
        self.issued = "issued-token-1"
        threading.Thread(target=self.accept_clients, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
        if self.failures:
            raise self.failures[0]

    def close(self):
        with contextlib.suppress(OSError):
            self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        self.drop_clients()

    def drop_clients(self):
        for client in self.clients:
            with contextlib.suppress(OSError):
                client.shutdown(socket.SHUT_RDWR)

    def accept_clients(self):
        with contextlib.suppress(OSError):  # closed
            while True:
                client, _ = self.listener.accept()
                client.settimeout(PATIENCE)
                self.clients.append(client)
                threading.Thread(target=self.handle, args=(client,), daemon=True).start()

    def handle(self, client):
        with client:
            try:
                self.behave(Connection(client))
            except (Closed, OSError):
                pass
            except Exception as failure:  # of the client's protocol, for the test
                self.failures.append(failure)

    def request(self, wanted):
        """The data of the next request of this type; others before it are skipped."""
        while True:
            kind, data = self.requests.get(timeout=PATIENCE)
            if kind == wanted:
                return data

    def serve(self, connection):
        connection.accept()
        authenticated = False
        while True:
            authenticated = self.reply(connection, connection.message(), authenticated) or authenticated

    def reply(self, connection, message, authenticated):
        """Answers a request; returns whether it has authenticated the client."""
        kind, data = message["messageType"], message["data"]
        if kind == "InjectParameterDataRequest":
            self.inject(connection, message, authenticated)
            return False
        self.requests.put((kind, data))
        if kind == "APIStateRequest":
            connection.answer(message, "APIStateResponse", {"active": True, "vTubeStudioVersion": "1.9.0", "currentSessionAuthenticated": False})
        elif kind == "AuthenticationTokenRequest":
            self.ask_user(connection, message)
        elif kind == "AuthenticationRequest":
            valid = data["authenticationToken"] in self.valid_tokens
            connection.answer(message, "AuthenticationResponse", {"authenticated": valid, "reason": "Token valid." if valid else "Token invalid."})
            return valid
        elif kind == "ParameterCreationRequest":
            self.created.add(data["parameterName"])
            connection.answer(message, "ParameterCreationResponse", {"parameterName": data["parameterName"]})
        else:
            raise ValueError(kind)
        return False

    def ask_user(self, connection, message):
        connection.answer(message, "AuthenticationTokenResponse", {"authenticationToken": self.issued})

    def inject(self, connection, message, authenticated):
        if not authenticated:
            raise ValueError("injection without authentication")
        self.injections.put(message["data"])
        connection.answer(message, "InjectParameterDataResponse", {})
