"""Receives datagrams without waiting."""

import socket
import sys

from .frame import FaceDataError
from .packets import decode

LOOPBACK, ANY = "127.0.0.1", "0.0.0.0"
_MAX_DATAGRAM = 65536
_MAX_PER_POLL = 256  # so that a flood does not block the window


class Receiver:
    """A socket on a port, from which `poll` takes all frames that have arrived."""

    def __init__(self, port, host=LOOPBACK, llf_rotation="rad"):
        self.llf_rotation = llf_rotation
        self.frames = self.errors = 0
        self.last_error = ""
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            if sys.platform == "win32":
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
            self._socket.bind((host, port))
            self._socket.setblocking(False)
        except (OSError, OverflowError) as error:
            self.close()
            raise FaceDataError(f"port: cannot listen on {host}:{port} ({error})") from None
        self.port = self._socket.getsockname()[1]

    def close(self):
        self._socket.close()

    def poll(self):
        """Frames in order of arrival. Packets that cannot be read are counted and described by last_error."""
        frames = []
        for _ in range(_MAX_PER_POLL):
            try:
                data = self._socket.recv(_MAX_DATAGRAM)
            except BlockingIOError:
                break
            except OSError as error:  # Windows reports errors of other packets here
                self._failed(error.strerror or str(error))
                break
            try:
                frames.append(decode(data, self.llf_rotation))
            except FaceDataError as error:
                self._failed(str(error))
        self.frames += len(frames)
        return frames

    def _failed(self, what):
        self.errors += 1
        self.last_error = what
