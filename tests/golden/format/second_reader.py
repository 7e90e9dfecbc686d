#!/usr/bin/env python3
"""A minimal reader of .mien files, written from docs/format.md only and without code of the other readers.

usage: second_reader.py FILE...     prints name and status of each file, and its content if the status is kOk
"""
import struct
import sys

NOTHING = 2**32 - 1


class Refused(Exception):
    pass


def check(condition, status):
    if not condition:
        raise Refused(status)


def rotate(x, n):
    return ((x << n) | (x >> (64 - n))) % 2**64


def xxh64(data):
    """From the xxHash specification, step by step."""
    p1, p2, p3 = 11400714785074694791, 14029467366897019727, 1609587929392839161
    p4, p5 = 9650029242287828579, 2870177450012600261

    def step(acc, lane):
        return rotate((acc + lane * p2) % 2**64, 31) * p1 % 2**64

    acc, rest = p5, data
    if len(data) >= 32:
        accs = [(p1 + p2) % 2**64, p2, 0, -p1 % 2**64]
        whole = len(data) // 32 * 32
        for lanes in struct.iter_unpack("<4Q", data[:whole]):
            accs = [step(a, lane) for a, lane in zip(accs, lanes)]
        acc = (rotate(accs[0], 1) + rotate(accs[1], 7) + rotate(accs[2], 12) + rotate(accs[3], 18)) % 2**64
        for a in accs:
            acc = ((acc ^ step(0, a)) * p1 + p4) % 2**64
        rest = data[whole:]
    acc = (acc + len(data)) % 2**64
    while len(rest) >= 8:
        acc = (rotate(acc ^ step(0, int.from_bytes(rest[:8], "little")), 27) * p1 + p4) % 2**64
        rest = rest[8:]
    if len(rest) >= 4:
        acc = (rotate(acc ^ (int.from_bytes(rest[:4], "little") * p1 % 2**64), 23) * p2 + p3) % 2**64
        rest = rest[4:]
    for byte in rest:
        acc = rotate(acc ^ (byte * p5 % 2**64), 11) * p1 % 2**64
    acc = (acc ^ (acc >> 33)) * p2 % 2**64
    acc = (acc ^ (acc >> 29)) * p3 % 2**64
    return acc ^ (acc >> 32)


def round8(n):
    return (n + 7) // 8 * 8


def map_ok(shape):
    h, w, c = shape
    return all(1 <= n <= 2**20 for n in shape) and h * w * round8(c) <= 2**28


class Reader:
    def __init__(self, data):
        self.data = data
        self.next_string = 0
        self.lines = []
        self.header()
        self.sections()
        self.strings()
        self.tensors()
        self.networks()

    def header(self):
        check(len(self.data) >= 64, "kTruncated")
        (magic, major, minor, endian, header_bytes, self.network_count, self.layer_count, self.tensor_count,
         self.metadata_count, self.string_bytes, total, self.data_offset, checksum) = struct.unpack_from("<8sHHIIIIIIIQQQ", self.data)
        check(magic == bytes.fromhex("894D49454E0D0A1A"), "kBadMagic")
        check(endian == 0x01020304, "kWrongEndian")
        check(major == 1 and minor <= 3 and header_bytes == 64, "kUnsupportedVersion")
        self.minor = minor
        check(total <= 2**31, "kLimitExceeded")
        check(total <= len(self.data), "kTruncated")
        check(total >= len(self.data), "kTrailingBytes")
        check(1 <= self.network_count <= 64 and self.layer_count <= 1024 and self.tensor_count <= 4096
              and self.metadata_count <= 256, "kLimitExceeded")
        check(xxh64(self.data[:56] + bytes(8) + self.data[64:]) == checksum, "kBadChecksum")

    def sections(self):
        at, starts = 64, []
        for size in (64 * self.network_count, 64 * self.layer_count, 64 * self.tensor_count, 16 * self.metadata_count,
                     self.string_bytes):
            starts.append(at)
            at += size
        check(at <= len(self.data), "kTruncated")
        self.starts = starts
        check(self.data_offset == (at + 63) // 64 * 64 <= len(self.data), "kHole")
        check(not any(self.data[at:self.data_offset]), "kPaddingNotZero")

    def records(self, section, count, layout):
        size = struct.calcsize(layout)
        return [struct.unpack_from(layout, self.data, self.starts[section] + size * i) for i in range(count)]

    def string(self, offset, size):
        check(offset == self.next_string and offset + size <= self.string_bytes, "kHole")
        self.next_string += size
        start = self.starts[4] + offset
        return self.data[start:start + size]

    def name(self, offset, size):
        text = self.string(offset, size)
        check(1 <= size <= 63 and all(c in b"abcdefghijklmnopqrstuvwxyz0123456789_./" for c in text), "kBadName")
        return text.decode()

    def text(self, offset, size):
        text = self.string(offset, size)
        check(size <= 4096 and not any((c < 32 and c not in b"\t\n") or c == 127 for c in text), "kBadMetadata")
        try:
            text = text.decode("utf-8")
        except UnicodeDecodeError:
            raise Refused("kBadMetadata")
        check(not any(0x80 <= ord(c) <= 0x9F for c in text), "kBadMetadata")
        return text

    def strings(self):
        self.network_records = self.records(0, self.network_count, "<2I3I3I1I14H")
        self.layer_records = self.records(1, self.layer_count, "<2H2I3I8H2Hf3I4s")
        self.tensor_records = self.records(2, self.tensor_count, "<2I2HI4I2Q4I")
        self.names = [self.name(*r[:2]) for r in self.network_records]
        self.tensor_names = [self.name(*r[:2]) if r[1] else self.string(*r[:2]).decode() for r in self.tensor_records]
        self.metadata = [(self.name(*r[:2]), self.text(*r[2:])) for r in self.records(3, self.metadata_count, "<4I")]
        check(self.next_string == self.string_bytes, "kHole")
        for names in self.names, [n for n in self.tensor_names if n], [key for key, _ in self.metadata]:
            check(len(names) == len(set(names)), "kDuplicateName")

    def tensors(self):
        at = self.data_offset
        self.dims, self.types = [], []
        for _, _, kind, rank, reserved, *rest in self.tensor_records:
            dims, (offset, size), tail = rest[:4], rest[4:6], rest[6:]
            check(kind in (1, 2), "kBadType")
            check(reserved == 0 and not any(tail), "kReservedNotZero")
            check(1 <= rank <= 4 and all(1 <= n <= 2**20 for n in dims[:rank]) and not any(dims[rank:]), "kBadDims")
            count = 1
            for n in dims[:rank]:
                count *= n
            check(size == count * 2 * kind, "kBadTensorBytes")
            check(offset == at, "kHole")
            end = (offset + size + 63) // 64 * 64
            check(end <= len(self.data), "kTruncated")
            exponent = 0x7C00 if kind == 1 else 0x7F800000
            words = struct.unpack_from(f"<{count}{'H' if kind == 1 else 'I'}", self.data, offset)
            check(all(word & exponent != exponent for word in words), "kNonFinite")
            check(not any(self.data[offset + size:end]), "kPaddingNotZero")
            at = end
            self.dims.append(dims[:rank])
            self.types.append(kind)
        check(at == len(self.data), "kHole")

    def networks(self):
        self.layer = self.tensor = 0
        for name, record in zip(self.names, self.network_records):
            self.network(name, record)
        check(self.layer == self.layer_count, "kBadNetwork")
        needed = [2 if fields[0] >= 14 or fields[1] >= 8 else 1 if fields[0] >= 11 else 0 for fields in self.layer_records]
        needed += [2 if record[8] > 4 else 0 for record in self.network_records]
        needed += [3 for fields in self.layer_records if any(fields[-1])]
        check(self.minor == max(needed, default=0), "kUnsupportedVersion")
        for index in range(self.tensor, self.tensor_count):
            check(self.tensor_names[index], "kUnusedTensor")
            self.lines.append(f"constant {self.tensor_names[index]} {'fp16' if self.types[index] == 1 else 'fp32'} "
                              + "x".join(map(str, self.dims[index])))
        self.lines += [f"metadata {key} {len(value.encode())}" for key, value in self.metadata]

    def network(self, name, record):
        h, w, c, flags, first, count, output_count = record[2:9]
        places = record[9:]
        wide = output_count <= 4
        check(not wide or not any(places[8:]), "kReservedNotZero")
        outputs = [places[i] + 65536 * places[i + 1] for i in range(0, 8, 2)] if wide else list(places)
        check(map_ok((h, w, c)) and flags in (0, 1) and first == self.layer and count >= 1
              and first + count <= self.layer_count, "kBadNetwork")
        self.lines.append(f"network {name} {h}x{w}x{c} flags {flags} outputs {' '.join(map(str, outputs[:output_count]))}")
        self.layer += count
        values = [(h, w, c)]
        for fields in self.layer_records[first:first + count]:
            values.append(self.one_layer(fields, values, flags))
        check(1 <= output_count <= (14 if self.minor >= 2 else 4) and all(1 <= v <= count for v in outputs[:output_count])
              and not any(outputs[output_count:]), "kBadNetwork")

    def one_layer(self, fields, values, flags):
        (op, activation, x, second, h, w, channels, kh, kw, sy, sx, top, left, bottom, right, layer_flags, first, alpha,
         weights, bias, slopes, input_bound) = fields
        check(1 <= op <= (10, 13, 19, 19)[self.minor] and not (flags and (op in (4, 5, 6, 18) or op == 17 and 0 in (sy, sx))), "kBadOp")
        bounded = any(input_bound)
        check((first == 0 or op == 13) and (not bounded or op == 3 and self.minor >= 3), "kReservedNotZero")
        check(not bounded or 2.0**-64 <= struct.unpack("<f", input_bound)[0] <= 2.0**64, "kBadActivation")
        two = op in (8, 12, 14, 15, 16)
        check(x < len(values) and (second < len(values) if two else second == NOTHING), "kBadReference")
        window = (kh, kw, sy, sx, top, left, bottom, right)
        if op in (1, 2, 7):
            check(all(1 <= n <= 15 for n in window[:4]) and max(top, bottom) < kh and max(left, right) < kw, "kBadKernel")
        else:
            zeros = window[:4] if op == 13 else window[:2] + window[4:] if op == 17 else window
            check(not any(zeros), "kBadKernel")
        resize_flags = [grid + 4 * sampling for grid in range(3) for sampling in range(5)]
        check(layer_flags in {7: (0, 1), 17: resize_flags, 18: range(6)}.get(op, (0,)), "kBadKernel")
        own = 8 <= activation <= 14 and op == 9 and self.minor >= 2
        check((activation <= 7 or own) and not (activation and op in (6, 7, 8, *range(10, 20))) and not (activation == 0 and op == 9), "kBadActivation")
        check(0 < alpha < 1 if activation == 3 or op == 19 else struct.pack("<f", alpha) == bytes(4), "kBadActivation")
        a = values[x]
        shape = self.derived(op, a, values[second] if two else a, channels, window, layer_flags, first, (h, w))
        check(shape == (h, w, channels) and map_ok(shape), "kBadShape")
        dims = self.weight_dims(op, a, channels, kh, kw)
        n8 = round8(channels)
        outputs = 4 * channels if op == 6 else channels
        used = self.used_elements(op, a)
        self.take(weights, dims, 8 if op == 2 else 16, lambda output, k: output < outputs and used(k))
        self.take(bias, dims and [4 * channels if op == 6 else n8], 8, lambda output, _: output < outputs)
        self.take(slopes, [n8] if activation == 4 else None, 8, lambda output, _: output < channels)
        self.lines.append(f"layer {op} activation {activation} inputs {x} {second} output {h}x{w}x{channels}")
        return shape

    def derived(self, op, a, b, n, window, flags, first, declared):
        h, w, c = a
        kh, kw, sy, sx, top, left, bottom, right = window
        if op in (1, 2, 7):
            return (self.windows(h, kh, sy, top, bottom, flags), self.windows(w, kw, sx, left, right, flags), n if op == 1 else c)
        if op in (5, 6):
            check((h, w) == (1, 1) and (op == 5 or n % 8 == 0), "kBadShape")
        if op == 8:
            check(b[2] == c and b[0] >= h and b[1] >= w and (b[0] - h) % 2 == 0 and (b[1] - w) % 2 == 0, "kBadShape")
        if op == 12:
            check((h, w) == b[:2], "kBadShape")
            return h, w, c + b[2]
        if op == 13:
            check(first + n <= c, "kBadShape")
            return h - top - bottom, w - left - right, n
        if op in (14, 15, 16):
            check(all(of_b in (of_a, 1) for of_a, of_b in zip(a, b)), "kBadShape")
        if op == 17:
            for factor, old, new in ((sy, h, declared[0]), (sx, w, declared[1])):
                whole = new % old == 0 and new // old < 2**16
                check(factor == (new // old if whole else 0), "kBadShape")
            return *declared, c
        if op == 18:
            check(map_ok((*declared, n)) and declared[0] * declared[1] * n == h * w * c, "kBadShape")
            return *declared, n
        return {11: (1, 1, c), 3: (h, w, n), 4: (1, 1, n), 5: (1, 1, n), 6: (1, 1, n)}.get(op, a)

    def windows(self, size, kernel, stride, before, after, ceil_mode):
        room = before + size + after - kernel
        check(room >= 0, "kBadShape")
        count = (-(-room // stride) if ceil_mode else room // stride) + 1
        check((count - 1) * stride < before + size, "kBadShape")
        return count

    def weight_dims(self, op, a, n, kh, kw):
        h, w, c = a
        n8, c8 = round8(n), round8(c)
        return {1: [n8, kh, kw, c], 2: [n8, kh, kw], 3: [n8, c8], 4: [n8, h * w * c8], 5: [n8, 2, c8],
                6: [4 * n, c8 + n]}.get(op)

    def used_elements(self, op, a):
        """Whether an element of the reduction belongs to a channel."""
        h, w, c = a
        c8 = round8(c)
        return {3: lambda k: k < c,
                4: lambda k: k // 8 // (h * w) * 8 + k % 8 < c,
                5: lambda k: k % c8 < c,
                6: lambda k: k < c or k >= c8}.get(op, lambda k: True)

    def take(self, index, dims, panel, used):
        if dims is None:
            check(index == NOTHING, "kBadTensor")
            return
        check(index == self.tensor < self.tensor_count, "kBadTensor")
        check(self.types[index] == 1 and self.dims[index] == dims and not self.tensor_names[index], "kBadTensor")
        self.lanes(index, panel, used)
        self.tensor += 1

    def lanes(self, index, panel, used):
        """Reads panels of this number of outputs, with a last one of 8 if necessary; elements of the reduction are consecutive."""
        outputs, *rest = self.dims[index]
        elements = 1
        for n in rest:
            elements *= n
        words = iter(struct.unpack_from(f"<{outputs * elements}H", self.data, self.tensor_records[index][9]))
        for first in range(0, outputs, panel):
            for k in range(elements):
                for output in range(first, min(first + panel, outputs)):
                    check(next(words) == 0 or used(output, k), "kPaddingNotZero")


def read(path):
    """Status and description."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        return "kOk", Reader(data).lines
    except Refused as refusal:
        return str(refusal), []


def main():
    for path in sys.argv[1:]:
        status, lines = read(path)
        print(path.rsplit("/", 1)[-1], status)
        for line in lines:
            print(" ", line)


if __name__ == "__main__":
    main()
