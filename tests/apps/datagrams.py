"""Receives datagrams for tests."""
import os
import socket
import threading


class Receiver:
    """Keeps all datagrams received at a port of this machine, by default a free one.

    A thread reads them, because the system drops those that do not fit its buffer, which is small on some machines.
    """

    def __init__(self, port=0):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", port))
        self.port = self.socket.getsockname()[1]
        self.end = os.urandom(16)
        self.kept, self.changed = [], threading.Condition()
        self.ends = 0
        self.thread = threading.Thread(target=self.receive, daemon=True)
        self.thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def receive(self):
        while packet := self.socket.recv(65536):
            with self.changed:
                if packet == self.end:
                    self.ends += 1
                else:
                    self.kept.append(packet)
                self.changed.notify_all()

    def send_to_self(self, packet):
        self.socket.sendto(packet, ("127.0.0.1", self.port))

    def close(self):
        while self.thread.is_alive():
            self.send_to_self(b"")
            self.thread.join(0.1)
        self.socket.close()

    def wait(self, wanted=len, seconds=60):
        """Waits until `wanted` accepts the list of packets, and returns the list."""
        with self.changed:
            if not self.changed.wait_for(lambda: wanted(self.kept), seconds):
                raise TimeoutError("no such packet")
            return list(self.kept)

    def packets(self):
        """Returns and forgets the packets sent before this call."""
        with self.changed:
            ends = self.ends
        self.send_to_self(self.end)
        with self.changed:
            if not self.changed.wait_for(lambda: self.ends > ends, 60):
                raise TimeoutError("the receiver is stuck")
            kept, self.kept = self.kept, []
            return kept
