#!/usr/bin/env python3
"""Writes accept/: files of ../format/accept, and many zeros in blocks of the largest size, packed; and reject/: small.packed with one
rule broken in each, and reject/expected.txt with lines "file status". Needs PYTHONPATH=scripts:apps/convert."""
import struct
import tempfile
from pathlib import Path

from mien_convert.weight_file import MienFile
from package.pack_weights import packed, table

HERE = Path(__file__).parent

FORMAT = HERE.parent / "format/accept"
SMALL = packed((FORMAT / "small.mien").read_bytes())
ZEROS = 1 << 17  # number of fp16 weights
BLOCK, LOW = 32, 36


def zeros():
    """A file of several blocks; most contain a single byte value."""
    file = MienFile()
    net = file.network("zeros", (1, 1, 256))
    net.output(net.pointwise(net.input, [[0.0] * 256] * (ZEROS // 256)))
    with tempfile.NamedTemporaryFile(suffix=".mien") as out:
        file.write(out.name)
        return Path(out.name).read_bytes()


def table_bytes(at, data=SMALL):
    return 32 + 2 * bin(int.from_bytes(data[at:at + 32], "little")).count("1")


HIGH = LOW + table_bytes(LOW)
STATES = HIGH + table_bytes(HIGH)
UNPACKED, = struct.unpack_from("<Q", SMALL, 24)


def changed(*changes):
    """small.packed with (format, offset, value)."""
    data = bytearray(SMALL)
    for layout, offset, value in changes:
        struct.pack_into("<" + layout, data, offset, value)
    return bytes(data)


def sized(data):
    """The file with a correct size field."""
    return data[:16] + struct.pack("<Q", len(data)) + data[24:]


def with_low_table(slots):
    return sized(SMALL[:LOW] + table(slots) + SMALL[HIGH:])


CASES = [
    ("empty", "kTruncated", b""),
    ("half_header", "kTruncated", SMALL[:31]),
    ("truncated", "kTruncated", SMALL[:-1]),
    ("packed_bytes_more", "kTruncated", changed(("Q", 16, 2**64 - 1))),
    ("packed_bytes_less", "kTrailingBytes", changed(("Q", 16, len(SMALL) - 2))),
    ("trailing", "kTrailingBytes", SMALL + b"\0"),
    ("magic", "kNotPacked", changed(("B", 4, 0x4E))),
    ("weight_file", "kNotPacked", (FORMAT / "smallest.mien").read_bytes()),
    ("major_version", "kUnsupportedVersion", changed(("H", 8, 2))),
    ("minor_version", "kUnsupportedVersion", changed(("H", 10, 1))),
    ("reserved", "kReservedNotZero", changed(("I", 12, 1))),
    ("nothing", "kBadSize", changed(("Q", 24, 0))),
    ("not_in_lines", "kBadSize", changed(("Q", 24, UNPACKED - 2))),
    ("too_large", "kBadSize", changed(("Q", 24, 2**31 + 64))),
    ("size_wraps", "kBadSize", changed(("Q", 24, 2**64 - 64))),
    ("more_than_blocks_can_hold", "kBadSize", changed(("Q", 24, (len(SMALL) - 32) // 80 * 65536 + 64))),
    ("header_alone", "kBadSize", sized(SMALL[:32])),
    ("block_of_nothing", "kBadBlock", changed(("I", BLOCK, 0))),
    ("block_not_in_lines", "kBadBlock", changed(("I", BLOCK, 2))),
    ("block_beyond_limit", "kBadBlock", changed(("Q", 24, 1 << 17), ("I", BLOCK, 65536 + 64))),
    ("block_beyond_end", "kBadBlock", changed(("I", BLOCK, UNPACKED + 64))),
    ("block_wraps", "kBadBlock", changed(("I", BLOCK, 2**32 - 64))),
    ("table_of_nothing", "kBadTable", sized(SMALL[:LOW] + bytes(32) + SMALL[HIGH:])),
    ("no_slots", "kBadTable", changed(("H", LOW + 32, 0))),
    ("slots_missing", "kBadTable", with_low_table([4095] + [0] * 255)),
    ("slots_too_many", "kBadTable", with_low_table([4096, 1] + [0] * 254)),
    ("slots_wrap", "kBadTable", with_low_table([65535, 4097] + [0] * 254)),
    ("low_state", "kBadState", changed(("I", STATES, 0xFFFF))),
    ("high_state", "kBadState", changed(("I", STATES + 4, 0))),
    ("last_state", "kBadState", changed(("H", len(SMALL) - 2, struct.unpack("<H", SMALL[-2:])[0] ^ 1))),
    ("ends_in_block_size", "kBytesMissing", sized(changed(("Q", 24, UNPACKED + 64)) + b"\x40\0")),
    ("ends_in_table", "kBytesMissing", sized(changed(("Q", 24, 64), ("I", BLOCK, 64))[:LOW + 80])),
    ("ends_in_states", "kBytesMissing", sized(SMALL[:STATES + 5])),
    ("ends_in_words", "kBytesMissing", sized(SMALL[:-2])),
    ("block_missing", "kBytesMissing", changed(("Q", 24, UNPACKED + 64))),
    ("word_left", "kBytesLeft", sized(SMALL + bytes(2))),
    ("block_left", "kBytesLeft", sized(SMALL + SMALL[BLOCK:])),
]


def main():
    for folder in HERE / "accept", HERE / "reject":
        folder.mkdir(exist_ok=True)
        for old in folder.glob("*.packed"):
            old.unlink()
    for name in "small", "smallest", "parts", "every_op":
        (HERE / f"accept/{name}.packed").write_bytes(packed((FORMAT / f"{name}.mien").read_bytes()))
    (HERE / "accept/zeros.packed").write_bytes(packed(zeros()))
    for name, _, data in CASES:
        (HERE / f"reject/{name}.packed").write_bytes(data)
    (HERE / "reject/expected.txt").write_text("".join(f"{name}.packed {status}\n" for name, status, _ in CASES))


if __name__ == "__main__":
    main()
