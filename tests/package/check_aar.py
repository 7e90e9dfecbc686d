#!/usr/bin/env python3
"""Checks an AAR: its files, prefab's descriptions, and that each library is for its ABI, has 16 KB pages and imports only Android's libraries.

usage: tests/package/check_aar.py FILE.aar ABI...
"""
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

# ABI: class and machine of the ELF file, by the names of binutils.
ABIS = {"arm64-v8a": ("ELF64", "AArch64"), "armeabi-v7a": ("ELF32", "ARM"), "x86_64": ("ELF64", "Advanced Micro Devices X86-64")}
MODULE = "prefab/modules/mien"
NEEDED = {"libc.so", "libm.so", "libdl.so", "liblog.so"}
PAGE = 0x4000
MINIMUM_API = 28
NATIVE = Path(__file__).resolve().parents[2] / "bindings/csharp/Runtime/Native.cs"
IMPORTED_BY_UNITY = re.findall(r"\[DllImport.* (mien_\w+)\(", NATIVE.read_text())


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


def check_library(name, data, abi):
    with tempfile.NamedTemporaryFile() as file:
        file.write(data)
        file.flush()
        done = subprocess.run(["readelf", "-hldW", "--dyn-syms", file.name], env={**os.environ, "LC_ALL": "C"}, capture_output=True, text=True)
    require(done.returncode == 0, f"{name}: not an ELF file")
    found = tuple(re.search(rf"^ *{field}: +(.*)$", done.stdout, re.M)[1] for field in ("Class", "Machine"))
    require(found == ABIS[abi], f"{name}: wrong machine (got {found}, expected {ABIS[abi]})")
    alignments = re.findall(r"^ *LOAD .* (0x[0-9a-f]+)$", done.stdout, re.M)
    require(alignments and all(int(n, 16) % PAGE == 0 for n in alignments), f"{name}: segments not aligned to 16 KB")
    needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", done.stdout))
    require(needed <= NEEDED, f"{name}: libraries: got {sorted(needed)}, expected some of {sorted(NEEDED)}")
    exported = set(re.findall(r" GLOBAL +DEFAULT +\d+ (\w+)", done.stdout))
    require(any(symbol.startswith("Java_org_mien_Native_") for symbol in exported), f"{name}: no function of org.mien.Native")
    missing = sorted(set(IMPORTED_BY_UNITY) - exported)
    require(not missing, f"{name}: no {', '.join(missing)}, which bindings/csharp imports")


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
