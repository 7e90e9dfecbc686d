#!/usr/bin/env python3
"""Checks an AAR: its files, prefab's descriptions, and that each library is for its ABI, has 16 KB pages and imports only Android's libraries.

usage: scripts/package/check_aar.py FILE.aar ABI...
"""
import io
import json
import struct
import sys
import zipfile
from xml.etree import ElementTree

# ABI: class of the ELF file, machine.
ABIS = {"arm64-v8a": (2, 183), "armeabi-v7a": (1, 40), "x86_64": (2, 62)}
MODULE = "prefab/modules/mien"
NEEDED = {"libc.so", "libm.so", "libdl.so", "liblog.so"}
LOAD, DYNAMIC, PAGE = 1, 2, 0x4000
DT_NULL, DT_NEEDED, DT_STRTAB = 0, 1, 5
MINIMUM_API = 28


class Invalid(Exception):
    pass


def require(condition, message):
    if not condition:
        raise Invalid(message)


def require_fields(name, value, expected):
    """`expected` maps each required field to its type; other fields are unknown to prefab."""
    require(set(value) == set(expected), f"{name}: got fields {sorted(value)}, expected {sorted(expected)}")
    for field, kind in expected.items():
        require(isinstance(value[field], kind), f"{name}: {field}: wrong type (got {value[field]!r}, expected {kind.__name__})")


class Elf:
    def __init__(self, data):
        require(data[:4] == b"\x7fELF" and data[5] == 1, "not a little-endian ELF file")
        self.data, self.bits = data, data[4]
        self.machine = struct.unpack_from("<H", data, 18)[0]
        wide = self.bits == 2
        offset, = struct.unpack_from("<Q" if wide else "<I", data, 32 if wide else 28)
        size, count = struct.unpack_from("<2H", data, 54 if wide else 42)
        self.segments = [self.segment(offset + i * size, wide) for i in range(count)]

    def segment(self, at, wide):
        if wide:
            kind, _, offset, address, _, size, _, align = struct.unpack_from("<2I6Q", self.data, at)
        else:
            kind, offset, address, _, size, _, _, align = struct.unpack_from("<8I", self.data, at)
        return {"kind": kind, "offset": offset, "address": address, "size": size, "align": align}

    def needed(self):
        dynamic = next(segment for segment in self.segments if segment["kind"] == DYNAMIC)
        form, step = ("<2Q", 16) if self.bits == 2 else ("<2I", 8)
        entries = [struct.unpack_from(form, self.data, dynamic["offset"] + i) for i in range(0, dynamic["size"], step)]
        entries = entries[:entries.index(next(entry for entry in entries if entry[0] == DT_NULL))]
        address = dict(entries)[DT_STRTAB]
        part = next(s for s in self.segments if s["kind"] == LOAD and s["address"] <= address < s["address"] + s["size"])
        strings = self.data[address - part["address"] + part["offset"]:]
        return {strings[value:].split(b"\0")[0].decode() for tag, value in entries if tag == DT_NEEDED}


def check_library(name, data, abi):
    elf = Elf(data)
    require((elf.bits, elf.machine) == ABIS[abi], f"{name}: wrong machine (got {elf.bits}, {elf.machine}, expected {ABIS[abi]})")
    require(all(s["align"] % PAGE == 0 for s in elf.segments if s["kind"] == LOAD), f"{name}: segments not aligned to 16 KB")
    require(elf.needed() <= NEEDED, f"{name}: libraries: got {sorted(elf.needed())}, expected some of {sorted(NEEDED)}")
    for symbol in (b"Java_org_mien_Native_", b"mien_tracker_create"):
        require(symbol in data, f"{name}: no exported {symbol.decode()}")


def check(path, abis):
    archive = zipfile.ZipFile(path)
    names = set(archive.namelist())
    read = lambda name: json.loads(archive.read(name))
    for name in ("AndroidManifest.xml", "classes.jar", "R.txt", f"{MODULE}/include/mien/mien.h", "assets/mien/basenet.mien", "assets/mien/proposal.mien"):
        require(name in names, f"{name}: missing")
    sdk = ElementTree.fromstring(archive.read("AndroidManifest.xml")).find("uses-sdk")
    minimum = sdk.get("{http://schemas.android.com/apk/res/android}minSdkVersion")
    require(minimum == str(MINIMUM_API), f"AndroidManifest.xml: minSdkVersion: got {minimum}, expected {MINIMUM_API}")
    require("org/mien/Tracker.class" in zipfile.ZipFile(io.BytesIO(archive.read("classes.jar"))).namelist(), "classes.jar: no org.mien.Tracker")
    package, module = read("prefab/prefab.json"), read(f"{MODULE}/module.json")
    require_fields("prefab.json", package, {"schema_version": int, "name": str, "version": str, "dependencies": list})
    require((package["schema_version"], package["name"]) == (2, "mien"), "prefab.json: got another schema or name, expected 2, mien")
    require_fields("module.json", module, {"export_libraries": list, "android": dict})
    require(module["android"] == {"library_name": "libmien_jni"}, f"module.json: android: got {module['android']}")
    folders = {name.split("/")[4] for name in names if name.startswith(f"{MODULE}/libs/") and not name.endswith("/libs/")}
    require(folders == {f"android.{abi}" for abi in abis}, f"{MODULE}/libs: got {sorted(folders)}, expected {abis}")
    for abi in abis:
        folder = f"{MODULE}/libs/android.{abi}"
        description = read(f"{folder}/abi.json")
        require_fields(f"{folder}/abi.json", description, {"abi": str, "api": int, "ndk": int, "stl": str, "static": bool})
        require(description["abi"] == abi and description["api"] == MINIMUM_API and not description["static"], f"{folder}/abi.json: got {description}")
        library = archive.read(f"{folder}/libmien_jni.so")
        require(library == archive.read(f"jni/{abi}/libmien_jni.so"), f"{folder}/libmien_jni.so: differs from that of jni/{abi}")
        check_library(f"{folder}/libmien_jni.so", library, abi)


if __name__ == "__main__":
    try:
        check(sys.argv[1], sys.argv[2:])
    except (Invalid, KeyError, StopIteration, ValueError) as error:
        sys.exit(f"{sys.argv[1]}: {error}")
    print(f"{sys.argv[1]}: valid for {', '.join(sys.argv[2:])}")
