#!/usr/bin/env python3
"""Writes the property list of an XCFramework, whose folders are named SYSTEM-PROCESSORS[-VARIANT].

usage: scripts/package/apple/info_plist.py FOLDER.xcframework
"""
import plistlib
import sys
from pathlib import Path


def library(identifier):
    platform, processors, *variant = identifier.split("-")
    return {"LibraryIdentifier": identifier, "LibraryPath": "libmien.a", "BinaryPath": "libmien.a", "HeadersPath": "Headers",
            "SupportedPlatform": platform, **{"SupportedPlatformVariant": name for name in variant},
            "SupportedArchitectures": [name for name in ("arm64", "x86_64") if name in processors]}


folder = Path(sys.argv[1])
libraries = [library(path.name) for path in sorted(folder.iterdir()) if path.is_dir()]
(folder / "Info.plist").write_bytes(plistlib.dumps(
    {"AvailableLibraries": libraries, "CFBundlePackageType": "XFWK", "XCFrameworkFormatVersion": "1.0"}))
