#!/usr/bin/env python3
"""Checks Mach-O programs and libraries: processors, minimum system, libraries, and the ad-hoc signature without which arm64 runs nothing.

usage: tests/package/check_macho.py FILE ARCHITECTURE... [--signed] [--library NAME]
  --signed   the arm64 part must be signed; any signature must fit        --library   what the file links beside the system's library
"""
import argparse
import hashlib
import struct
import sys
from pathlib import Path

ARCHITECTURES = {0x01000007: "x86_64", 0x0100000C: "arm64"}
FAT, MACHO64 = 0xCAFEBABE, 0xFEEDFACF
LOAD_DYLIB, CODE_SIGNATURE, BUILD_VERSION = 0xC, 0x1D, 0x32
SYSTEM = "/usr/lib/libSystem.B.dylib"
EXECUTABLE, POSITION_INDEPENDENT = 2, 0x200000
MACOS, NEWEST_MINIMUM = 1, (13, 3)
SUPER_BLOB, CODE_DIRECTORY, AD_HOC, SHA256 = 0xFADE0CC0, 0xFADE0C02, 0x2, 2


class Invalid(Exception):
    pass


def require(condition, message):
    if not condition:
        raise Invalid(message)


def parts(data):
    """Maps each architecture to its part of the file."""
    if struct.unpack_from(">I", data)[0] != FAT:
        return {ARCHITECTURES.get(struct.unpack_from("<I", data, 4)[0], "unknown"): data}
    found = {}
    for i in range(struct.unpack_from(">I", data, 4)[0]):
        cpu, _, offset, size, alignment = struct.unpack_from(">5I", data, 8 + 20 * i)
        require(offset % (1 << alignment) == 0, f"part {i}: misaligned (offset {offset}, alignment 2^{alignment})")
        found[ARCHITECTURES.get(cpu, "unknown")] = data[offset:offset + size]
    return found


def commands(data):
    magic, _, _, kind, count, _, flags, _ = struct.unpack_from("<8I", data)
    require(magic == MACHO64, f"magic: not a 64-bit Mach-O file (got {magic:#x})")
    require(kind != EXECUTABLE or flags & POSITION_INDEPENDENT, "flags: not position-independent")
    offset = 32
    for _ in range(count):
        command, size = struct.unpack_from("<2I", data, offset)
        yield command, data[offset:offset + size]
        offset += size


def check_signature(data, start, size):
    """Checks the hash of each page in the code directory."""
    blob = data[start:start + size]
    magic, _, count = struct.unpack_from(">3I", blob)
    require(magic == SUPER_BLOB, f"signature: unknown format (got {magic:#x})")
    offsets = [struct.unpack_from(">2I", blob, 12 + 8 * i)[1] for i in range(count)]
    directories = [blob[at:] for at in offsets if struct.unpack_from(">I", blob, at)[0] == CODE_DIRECTORY]
    require(directories, "signature: no code directory")
    directory = directories[0]
    _, _, _, flags, hashes, _, _, slots, limit = struct.unpack_from(">9I", directory)
    hash_size, hash_type, _, page_bits = struct.unpack_from(">4B", directory, 36)
    require(flags & AD_HOC, f"signature: not ad hoc (flags {flags:#x})")
    require((hash_size, hash_type) == (32, SHA256), f"signature: unknown hash (got type {hash_type}, expected {SHA256})")
    require(limit == start, f"signature: does not cover the file (got {limit} bytes, expected {start})")
    page = 1 << page_bits
    require(slots == -(-limit // page), f"signature: wrong number of pages (got {slots}, expected {-(-limit // page)})")
    for i in range(slots):
        digest = hashlib.sha256(data[i * page:min((i + 1) * page, limit)]).digest()
        require(directory[hashes + 32 * i:hashes + 32 * (i + 1)] == digest, f"signature: page {i} was changed")


def check_part(architecture, data, signed, expected):
    libraries, minimum, signature = [], None, None
    for command, content in commands(data):
        if command == LOAD_DYLIB:
            libraries.append(content[struct.unpack_from("<I", content, 8)[0]:].split(b"\0")[0].decode())
        elif command == BUILD_VERSION:
            platform, version = struct.unpack_from("<2I", content, 8)
            require(platform == MACOS, f"platform: not macOS (got {platform})")
            minimum = (version >> 16, version >> 8 & 0xFF)
        elif command == CODE_SIGNATURE:
            signature = struct.unpack_from("<2I", content, 8)
    require(sorted(libraries) == sorted(expected), f"libraries: got {libraries}, expected {expected}")
    require(minimum is not None and minimum <= NEWEST_MINIMUM, f"minimum macOS: got {minimum}, expected at most {NEWEST_MINIMUM}")
    require(signature is not None or not (signed and architecture == "arm64"), "signature: missing")
    if signature is not None:
        check_signature(data, *signature)
    return f"{architecture}, macOS {minimum[0]}.{minimum[1]}, {'signed ad hoc' if signature else 'not signed'}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("architectures", nargs="+")
    parser.add_argument("--signed", action="store_true")
    parser.add_argument("--library")
    options = parser.parse_args()
    try:
        found = parts(options.file.read_bytes())
        require(set(found) == set(options.architectures), f"architectures: got {sorted(found)}, expected {sorted(options.architectures)}")
        libraries = [SYSTEM] + ([options.library] if options.library else [])
        descriptions = [check_part(architecture, data, options.signed, libraries) for architecture, data in found.items()]
    except (Invalid, struct.error) as error:
        sys.exit(f"{options.file}: {error}")
    print(f"{options.file.name}: {'; '.join(descriptions)}")


if __name__ == "__main__":
    main()
