#!/usr/bin/env python3
"""A minimal reader of packed weight files, written from docs/format.md only and without code of the other readers.

usage: second_unpacker.py FOLDER FILE...     prints name and status of each file, and writes the unpacked file to FOLDER if the
status is kOk
"""
import struct
import sys
from pathlib import Path


class Refused(Exception):
    pass


def check(condition, status):
    if not condition:
        raise Refused(status)


class Input:
    def __init__(self, data):
        self.data = data

    def take(self, layout):
        size = struct.calcsize("<" + layout)
        check(size <= len(self.data), "kBytesMissing")
        values = struct.unpack("<" + layout, self.data[:size])
        self.data = self.data[size:]
        return values


def table(source):
    """For each slot: its byte, the byte's first slot, and how many it has."""
    present = int.from_bytes(bytes(source.take("32B")), "little")
    out = []
    for byte in range(256):
        if present >> byte & 1:
            slots, = source.take("H")
            check(slots > 0 and len(out) + slots <= 4096, "kBadTable")
            out += [(byte, len(out), slots)] * slots
    check(len(out) == 4096, "kBadTable")
    return out


def block(source, room):
    size, = source.take("I")
    check(size > 0 and size % 64 == 0 and size <= min(65536, room), "kBadBlock")
    tables = table(source), table(source)
    states = list(source.take("2I"))
    check(min(states) >= 2**16, "kBadState")
    out = bytearray()
    for at in range(size):
        which = at % 2
        x = states[which]
        byte, first, slots = tables[which][x % 4096]
        x = slots * (x // 4096) + x % 4096 - first
        if x < 2**16:
            x = 2**16 * x + source.take("H")[0]
        states[which] = x
        out.append(byte)
    check(states == [2**16, 2**16], "kBadState")
    return out


def unpacked(data):
    check(len(data) >= 32, "kTruncated")
    magic, major, minor, reserved, packed_bytes, file_bytes = struct.unpack_from("<8s2HI2Q", data)
    check(magic == bytes.fromhex("894D4945500D0A1A"), "kNotPacked")
    check((major, minor) == (1, 0), "kUnsupportedVersion")
    check(reserved == 0, "kReservedNotZero")
    check(len(data) >= packed_bytes, "kTruncated")
    check(len(data) == packed_bytes, "kTrailingBytes")
    check(64 <= file_bytes <= 2**31 and file_bytes % 64 == 0 and file_bytes <= (len(data) - 32) // 80 * 65536, "kBadSize")
    source, out = Input(data[32:]), bytearray()
    while len(out) < file_bytes:
        out += block(source, file_bytes - len(out))
    check(not source.data, "kBytesLeft")
    return out


def main():
    folder = Path(sys.argv[1])
    for path in map(Path, sys.argv[2:]):
        try:
            file = unpacked(path.read_bytes())
            (folder / path.name).write_bytes(file)
            print(path.name, "kOk")
        except Refused as refusal:
            print(path.name, refusal)


if __name__ == "__main__":
    main()
