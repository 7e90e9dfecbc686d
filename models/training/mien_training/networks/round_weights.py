"""Rounds the weights of .mien files to fewer significant bits, so they compress. Standard library only.

usage: python3 -m mien_training.networks.round_weights FILE.mien... [--bits N]
Rewrites the files; rounding again changes nothing. Biases, slopes, constants and metadata stay as they are, and so do
layers with few weights, which save little and matter most.
"""
import argparse
import struct
from pathlib import Path

from mien_convert.atomic_files import write_whole
from mien_convert.weight_file import NO_INDEX, RECORD_BYTES, sealed

BITS = 8                 # significant bits of the 11 of fp16; docs/packages.md has the error
FEW_WEIGHTS = 8192
INFINITY = 0x7C00        # of fp16


def rounded_number(number, bits=BITS):
    """fp16 as its 16 bits: to nearest, ties to even, never to infinity. A carry out of the mantissa is the next
    exponent."""
    drop = 11 - bits
    step = 1 << drop
    magnitude = number & 0x7FFF
    if drop:
        magnitude += step // 2 - 1 + (magnitude >> drop & 1)
    return number & 0x8000 | min(magnitude & -step, INFINITY - step)


def rounded(file, bits=BITS):
    """The bytes of a .mien file, which it trusts to be right, with the weights of all its layers rounded."""
    table = [rounded_number(number, bits) for number in range(1 << 16)]
    networks, layers, _ = struct.unpack_from("<3I", file, 20)
    first_layer = RECORD_BYTES * (1 + networks)  # the header is as long as a record
    first_tensor = first_layer + RECORD_BYTES * layers
    out = bytearray(file)
    for at in range(first_layer, first_tensor, RECORD_BYTES):
        index, = struct.unpack_from("<I", file, at + 48)
        if index != NO_INDEX:
            offset, size = struct.unpack_from("<2Q", file, first_tensor + RECORD_BYTES * index + 32)
            numbers = struct.unpack_from(f"<{size // 2}H", file, offset)
            if len(numbers) >= FEW_WEIGHTS:
                struct.pack_into(f"<{len(numbers)}H", out, offset, *(table[number] for number in numbers))
    return sealed(bytes(out))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--bits", type=int, choices=range(1, 12), default=BITS,
                        help=f"significant bits of a weight; default {BITS}")
    options = parser.parse_args()
    for path in options.files:
        write_whole(path, rounded(path.read_bytes(), options.bits))


if __name__ == "__main__":
    main()
