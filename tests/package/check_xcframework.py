#!/usr/bin/env python3
"""Checks an XCFramework: its property list, and that each library is for the listed system and processors.

usage: tests/package/check_xcframework.py FOLDER.xcframework
"""
import plistlib
import struct
import sys
from pathlib import Path

from check_macho import BUILD_VERSION, Invalid, commands, parts, require

PLATFORMS = {("macos", None): 1, ("ios", None): 2, ("ios", "simulator"): 7}
MINIMUM_MACOS = 0x24
REQUIRED = {"HeadersPath", "LibraryIdentifier", "LibraryPath", "BinaryPath", "SupportedArchitectures", "SupportedPlatform"}
PUBLIC = b"_mien_tracker_create\0"


def objects(archive):
    """The Mach-O members of an archive in BSD format."""
    require(archive[:8] == b"!<arch>\n", "not an archive")
    offset = 8
    while offset < len(archive):
        name, size = archive[offset:offset + 16].rstrip(), int(archive[offset + 48:offset + 58])
        begin, end = offset + 60, offset + 60 + size
        if name.startswith(b"#1/"):  # the name precedes the content
            begin += int(name[3:])
            name = archive[offset + 60:begin].rstrip(b"\0")
        if not name.startswith(b"__.SYMDEF"):
            require(begin % 8 == 0, f"{name.decode()}: not aligned to 8 bytes")
            yield name.decode(), archive[begin:end]
        offset = end + size % 2


def system_of(content):
    """(architecture, platform) of an object."""
    architecture, = parts(content)
    for command, fields in commands(content):
        if command == BUILD_VERSION:
            return architecture, struct.unpack_from("<I", fields, 8)[0]
        if command == MINIMUM_MACOS:
            return architecture, PLATFORMS["macos", None]
    raise Invalid("object names no system")


def check_library(folder, entry):
    identifier, platform = entry["LibraryIdentifier"], (entry["SupportedPlatform"], entry.get("SupportedPlatformVariant"))
    require(REQUIRED <= set(entry), f"{identifier}: missing fields {sorted(REQUIRED - set(entry))}")
    require(platform in PLATFORMS, f"{identifier}: unknown platform {platform}")
    headers = folder / identifier / entry["HeadersPath"]
    for name in ("module.modulemap", "mien/mien.h"):
        require((headers / name).is_file(), f"{identifier}: {name}: missing")
    found = set()
    library = (folder / identifier / entry["LibraryPath"]).read_bytes()
    thin = {None: library} if library.startswith(b"!<arch>\n") else parts(library)
    for named, archive in thin.items():
        members = list(objects(archive))
        require(members and any(PUBLIC in content for _, content in members), f"{identifier}: no mien_tracker_create")
        for name, content in members:
            architecture, system = system_of(content)
            require(system == PLATFORMS[platform], f"{identifier}: {name}: wrong platform (got {system}, expected {PLATFORMS[platform]})")
            require(named in (None, architecture), f"{identifier}: {name}: wrong processor (got {architecture}, expected {named})")
            found.add(architecture)
    require(sorted(found) == sorted(entry["SupportedArchitectures"]), f"{identifier}: architectures: got {sorted(found)}")


def check(folder):
    plist = plistlib.loads((folder / "Info.plist").read_bytes())
    require(plist.get("CFBundlePackageType") == "XFWK", "Info.plist: CFBundlePackageType: expected XFWK")
    require(plist.get("XCFrameworkFormatVersion") == "1.0", "Info.plist: XCFrameworkFormatVersion: expected 1.0")
    identifiers = [entry["LibraryIdentifier"] for entry in plist["AvailableLibraries"]]
    folders = sorted(path.name for path in folder.iterdir() if path.is_dir())
    require(sorted(identifiers) == folders, f"folders: got {folders}, expected {sorted(identifiers)}")
    for entry in plist["AvailableLibraries"]:
        check_library(folder, entry)
    return identifiers


if __name__ == "__main__":
    try:
        print(f"{sys.argv[1]}: valid for {', '.join(check(Path(sys.argv[1])))}")
    except (Invalid, KeyError, OSError, struct.error, ValueError) as error:
        sys.exit(f"{sys.argv[1]}: {error}")
