#!/usr/bin/env python3
"""Packs a .mien file without loss (docs/format.md), for programs with embedded weights. Standard library only.

usage: pack_weights.py FILE.mien PACKED
       pack_weights.py --any FILE PACKED        FILE: any content of a multiple of 64 bytes
mien_weights_create restores the file byte for byte.
"""
import math
import struct
import sys
from collections import Counter
from pathlib import Path

MAGIC = b"\x89MIEP\r\n\x1a"
WEIGHTS = b"\x89MIEN\r\n\x1a"
HEADER_BYTES = 32
BLOCK_BYTES = 1 << 16    # at most
SYMBOLS = 256
BITS = 12
SLOTS = 1 << BITS        # of a table
LOWEST = 1 << 16         # initial state of encoders and final state of decoders


def slots_of(counts):
    """The number of slots of each symbol: proportional to its count, at least one if it occurs."""
    total = sum(counts.values())
    slots = [max(1, round(counts[s] * SLOTS / total)) if counts[s] else 0 for s in range(SYMBOLS)]
    while sum(slots) != SLOTS:  # the most frequent symbol absorbs the rounding, which changes it least
        slots[slots.index(max(slots))] += 1 if sum(slots) < SLOTS else -1
    return slots


def table(slots):
    present = sum(1 << s for s in range(SYMBOLS) if slots[s])
    return present.to_bytes(SYMBOLS // 8, "little") + b"".join(struct.pack("<H", n) for n in slots if n)


class Coder:
    """rANS (Duda 2013). It encodes backwards: the decoder reads `words` from their end."""

    def __init__(self, slots, words):
        self.symbols = [(sum(slots[:s]), slots[s], slots[s] << (32 - BITS)) for s in range(SYMBOLS)]
        self.state, self.words = LOWEST, words

    def put(self, symbol):
        first, slots, limit = self.symbols[symbol]
        if self.state >= limit:
            self.words.append(self.state & 0xFFFF)
            self.state >>= 16
        self.state = (self.state // slots << BITS) + self.state % slots + first


def planes(data):
    """Low and high bytes of 16-bit numbers, which most of a weight file consists of."""
    return data[0::2], data[1::2]


def block(data):
    slots = [slots_of(Counter(plane)) for plane in planes(data)]
    words = []
    low, high = (Coder(s, words) for s in slots)
    for a, b in zip(*map(reversed, planes(data))):
        high.put(b)
        low.put(a)
    words.reverse()
    return struct.pack("<I", len(data)) + b"".join(map(table, slots)) + struct.pack(f"<2I{len(words)}H", low.state, high.state, *words)


def cost(counts):
    """Estimated bytes of a plane: its table, and its entropy."""
    total = sum(counts.values())
    return SYMBOLS // 8 + 2 * len(counts) + sum(n * math.log2(total / n) for n in counts.values()) / 8


def cuts_of(file):
    """Allowed bounds of blocks: those of tensors of a weight file (docs/format.md), and positions inside tensors longer than a block."""
    if not file.startswith(WEIGHTS):
        return [*range(0, len(file), 4096), len(file)]
    networks, layers, tensors = struct.unpack_from("<3I", file, 20)
    records = range(64 * (1 + networks + layers), 64 * (1 + networks + layers + tensors), 64)
    bounds = [0, *(struct.unpack_from("<Q", file, at + 32)[0] for at in records), len(file)]
    return [at for begin, end in zip(bounds, bounds[1:]) for at in range(begin, end, BLOCK_BYTES)] + [len(file)]


def blocks(file):
    """The bounds with the minimum total size, as a shortest path: more blocks fit their content better, but need more tables."""
    cuts = cuts_of(file)
    pieces = [tuple(map(Counter, planes(file[begin:end]))) for begin, end in zip(cuts, cuts[1:])]
    best = [(0, 0)]  # for each bound: total bytes, and start of the last block
    for last, end in enumerate(cuts[1:]):
        low, high, ways = Counter(), Counter(), []
        for first in range(last, -1, -1):
            if end - cuts[first] > BLOCK_BYTES:
                break
            low.update(pieces[first][0])
            high.update(pieces[first][1])
            ways.append((best[first][0] + cost(low) + cost(high), first))
        best.append(min(ways))
    path = [len(pieces)]
    while path[-1] > 0:
        path.append(best[path[-1]][1])
    return [file[cuts[first]:cuts[last]] for last, first in zip(path, path[1:])][::-1]


def packed(file):
    body = b"".join(map(block, blocks(file)))
    return struct.pack("<8s2HI2Q", MAGIC, 1, 0, 0, HEADER_BYTES + len(body), len(file)) + body


def main():
    arguments = sys.argv[1:]
    any_content = arguments[:1] == ["--any"]
    if len(arguments) != 2 + any_content:
        sys.exit(__doc__)
    source, target = arguments[-2:]
    file = Path(source).read_bytes()
    if not any_content and not file.startswith(WEIGHTS):
        sys.exit(f"{source}: not a .mien file")
    Path(target).write_bytes(packed(file))


if __name__ == "__main__":
    main()
