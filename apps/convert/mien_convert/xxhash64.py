"""The checksum of weight files."""
import struct


def xxhash64(data):
    """XXH64 with seed 0."""
    p1, p2, p3 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9
    p4, p5 = 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5
    mask = (1 << 64) - 1

    def rotated(x, bits):
        return (x << bits | x >> (64 - bits)) & mask

    def mixed(lane, word):
        return rotated((lane + word * p2) & mask, 31) * p1 & mask

    lanes = [(p1 + p2) & mask, p2, 0, -p1 & mask]
    stripes = len(data) // 32 * 4
    words = struct.unpack_from(f"<{stripes}Q", data)
    for index in range(4):
        lane = lanes[index]
        for word in words[index::4]:
            lane = (lane + word * p2) & mask
            lane = (lane << 31 | lane >> 33) * p1 & mask  # the multiplication drops the bits that the shift moved out
        lanes[index] = lane
    value = p5
    if stripes:
        value = sum(rotated(lane, bits) for lane, bits in zip(lanes, (1, 7, 12, 18))) & mask
        for lane in lanes:
            value = ((value ^ mixed(0, lane)) * p1 + p4) & mask
    value = (value + len(data)) & mask
    for at in range(8 * stripes, len(data) - 7, 8):
        value = (rotated(value ^ mixed(0, struct.unpack_from("<Q", data, at)[0]), 27) * p1 + p4) & mask
    at = len(data) // 8 * 8
    if len(data) - at >= 4:
        value = (rotated(value ^ struct.unpack_from("<I", data, at)[0] * p1 & mask, 23) * p2 + p3) & mask
        at += 4
    for byte in data[at:]:
        value = rotated(value ^ byte * p5 & mask, 11) * p1 & mask
    value = (value ^ value >> 33) * p2 & mask
    value = (value ^ value >> 29) * p3 & mask
    return value ^ value >> 32
