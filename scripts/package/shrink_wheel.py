#!/usr/bin/env python3
"""Compresses a wheel's files again with Zopfli, which finds shorter deflate streams than zlib.

Names, dates, modes and order of the files stay.

usage: scripts/package/shrink_wheel.py WHEEL      needs the packages of wheel_requirements.txt
"""
import os
import struct
import sys
import zipfile
import zlib
from pathlib import Path

import zopfli.zlib

COMPRESSIBLE = 0.95  # packed weights are not, and would take long
ITERATIONS = 5       # more gain 0.1 %
VERSION = 20         # of zip, needed for deflate


def deflated(data):
    fast = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    result = fast.compress(data) + fast.flush()
    if len(result) < COMPRESSIBLE * len(data):
        container = zopfli.zlib.compress(data, numiterations=ITERATIONS, blocksplittingmax=0)
        result = min(result, container[2:-4], key=len)  # without its header and checksum
    return result


def fields(info, packed):
    """The fields that both headers of an entry share, after their magic numbers and versions."""
    year, month, day, hour, minute, second = info.date_time
    time, date = hour << 11 | minute << 5 | second // 2, (year - 1980) << 9 | month << 5 | day
    sizes = len(packed), info.file_size, len(info.filename), 0
    return struct.pack("<4H3I2H", 0, zipfile.ZIP_DEFLATED, time, date, info.CRC, *sizes)


def shrunk(archive):
    body, directory = b"", b""
    for info in archive.infolist():
        packed, name = deflated(archive.read(info)), info.filename.encode("ascii")
        both = fields(info, packed)
        directory += b"PK\1\2" + struct.pack("<2H", info.create_system << 8 | VERSION, VERSION) + both
        directory += struct.pack("<3H2I", 0, 0, 0, info.external_attr, len(body)) + name
        body += b"PK\3\4" + struct.pack("<H", VERSION) + both + name + packed
    count = len(archive.infolist())
    return body + directory + b"PK\5\6" + struct.pack("<4H2IH", 0, 0, count, count, len(directory), len(body), 0)


def content(path):
    with zipfile.ZipFile(path) as archive:
        return [(info.filename, info.date_time, info.external_attr, archive.read(info)) for info in archive.infolist()]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    wheel = Path(sys.argv[1])
    smaller = wheel.with_suffix(".shrunk")
    with zipfile.ZipFile(wheel) as archive:
        smaller.write_bytes(shrunk(archive))
    if content(smaller) != content(wheel):
        sys.exit(f"{smaller}: content differs from {wheel}")
    os.replace(smaller, wheel)


if __name__ == "__main__":
    main()
