"""Tests of the checks of packages (check_aar.py, check_xcframework.py), and of scripts/package: sbom.py and sizes.py.

usage: checks_test.py
"""
import json
import os
import pathlib
import plistlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "scripts/package"))
import check_aar  # noqa: E402
import check_xcframework  # noqa: E402
import sbom  # noqa: E402
import sizes  # noqa: E402

SYMBOLS = "".join(f"void {name}(void) {{}}\n" for name in ("Java_org_mien_Native_create", *check_aar.IMPORTED_BY_UNITY))
LIBTOOL = sorted(pathlib.Path("/usr/lib").glob("llvm-*/bin/llvm-libtool-darwin"))


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_tool(self, *command):
        subprocess.run([str(part) for part in command], check=True, cwd=self.folder, capture_output=True)


@unittest.skipUnless(shutil.which("clang") and shutil.which("ld.lld"), "clang and lld are missing")
class Aar(Folder):
    def library(self, page_size=16384, libraries=("libc.so",), target="aarch64-linux-android28", symbols=SYMBOLS):
        (self.folder / "a.c").write_text(symbols)
        for name, source in (("a", "a.c"), ("empty", "/dev/null")):
            self.run_tool("clang", "-target", target, "-x", "c", "-fPIC", "-c", source, "-o", f"{name}.o")
        for name in libraries:
            self.run_tool("ld.lld", "-shared", "-soname", name, "empty.o", "-o", name)
        self.run_tool("ld.lld", "-shared", "-z", f"max-page-size={page_size}", "a.o", *libraries, "-o", "libmien_jni.so")
        return (self.folder / "libmien_jni.so").read_bytes()

    def check(self, library, **changes):
        """Checks an AAR for arm64-v8a; `changes` map names of files, with _ for / and ., to contents."""
        classes = self.folder / "classes.jar"
        with zipfile.ZipFile(classes, "w") as archive:
            archive.writestr("org/mien/Tracker.class", "")
        module = check_aar.MODULE
        files = {
            "AndroidManifest.xml": (SOURCE / "bindings/android/prefab/AndroidManifest.xml").read_bytes(), "R.txt": b"",
            "classes.jar": classes.read_bytes(), "assets/mien/basenet.mien": b"", "assets/mien/proposal.mien": b"",
            "prefab/prefab.json": (SOURCE / "bindings/android/prefab/prefab.json").read_bytes(), f"{module}/include/mien/mien.h": b"",
            f"{module}/module.json": (SOURCE / "bindings/android/prefab/module.json").read_bytes(), "jni/arm64-v8a/libmien_jni.so": library,
            f"{module}/libs/android.arm64-v8a/libmien_jni.so": library,
            f"{module}/libs/android.arm64-v8a/abi.json":
                json.dumps({"abi": "arm64-v8a", "api": 28, "ndk": 26, "stl": "none", "static": False}).encode(),
        }
        for name in files:
            files[name] = changes.get(name.split("/")[-1].replace(".", "_"), files[name])
        with zipfile.ZipFile(self.folder / "mien.aar", "w") as archive:
            for name, content in files.items():
                archive.writestr(name, content)
        check_aar.check(self.folder / "mien.aar", ["arm64-v8a"])

    def test_valid(self):
        self.check(self.library())

    def test_small_pages(self):
        with self.assertRaisesRegex(check_aar.Invalid, "16 KB"):
            self.check(self.library(page_size=4096))

    def test_library_that_android_lacks(self):
        with self.assertRaisesRegex(check_aar.Invalid, "libc.so.6"):
            self.check(self.library(libraries=("libc.so.6",)))

    def test_wrong_machine(self):
        with self.assertRaisesRegex(check_aar.Invalid, "wrong machine"):
            self.check(self.library(target="x86_64-linux-android28"))

    def test_function_that_unity_imports_and_the_library_hides(self):
        hidden = SYMBOLS.replace("void mien_tracker_create(", "static void mien_tracker_create(")
        with self.assertRaisesRegex(check_aar.Invalid, "no mien_tracker_create, which"):
            self.check(self.library(symbols=hidden))

    def test_unknown_field(self):
        with self.assertRaisesRegex(check_aar.Invalid, "module.json"):
            self.check(self.library(), module_json=b'{"export_libraries": [], "android": {}, "other": 1}')

    def test_old_system(self):
        manifest = (SOURCE / "bindings/android/prefab/AndroidManifest.xml").read_bytes().replace(b'"28"', b'"21"')
        with self.assertRaisesRegex(check_aar.Invalid, "minSdkVersion"):
            self.check(self.library(), AndroidManifest_xml=manifest)


@unittest.skipUnless(shutil.which("clang") and LIBTOOL, "clang and llvm-libtool-darwin are missing")
class XCFramework(Folder):
    def framework(self, triple="arm64-apple-ios15.0", architectures=("arm64",)):
        """With one library, for iOS."""
        library = self.folder / "M.xcframework/ios-arm64"
        (library / "Headers/mien").mkdir(parents=True)
        for name in ("Headers/module.modulemap", "Headers/mien/mien.h"):
            (library / name).touch()
        (self.folder / "a.c").write_text(SYMBOLS)
        self.run_tool("clang", "-target", triple, "-c", "a.c", "-o", "a.o")
        self.run_tool(LIBTOOL[-1], "-static", "-D", "-o", library / "libmien.a", "a.o")
        self.run_tool(SOURCE / "scripts/package/apple/info_plist.py", self.folder / "M.xcframework")
        listed = self.folder / "M.xcframework/Info.plist"
        plist = plistlib.loads(listed.read_bytes())
        plist["AvailableLibraries"][0]["SupportedArchitectures"] = list(architectures)
        listed.write_bytes(plistlib.dumps(plist))
        return self.folder / "M.xcframework"

    def test_valid(self):
        self.assertEqual(check_xcframework.check(self.framework()), ["ios-arm64"])

    def test_object_for_another_system(self):
        with self.assertRaisesRegex(check_xcframework.Invalid, "wrong platform"):
            check_xcframework.check(self.framework("arm64-apple-macos13.0"))

    def test_missing_architecture(self):
        with self.assertRaisesRegex(check_xcframework.Invalid, "architectures"):
            check_xcframework.check(self.framework(architectures=("arm64", "x86_64")))

    def test_folder_that_the_list_does_not_name(self):
        framework = self.framework()
        (framework / "tvos-arm64").mkdir()
        with self.assertRaisesRegex(check_xcframework.Invalid, "folders"):
            check_xcframework.check(framework)


class Release(Folder):
    def test_functions_that_source_the_targets_share_them(self):
        script = "source_them() { . scripts/cross/zig_targets.sh; }; source_them; "
        script += "echo ${ZIG_TARGETS[macos-arm64]} ${LIBRARY_TARGETS[ios-arm64]}"
        printed = subprocess.run(["bash", "-euc", script], check=True, cwd=SOURCE, capture_output=True, text=True).stdout
        self.assertEqual(printed.split(), ["aarch64-macos.13.3", "arm64-apple-ios15.0"])

    @unittest.mock.patch.dict(os.environ, SOURCE_DATE_EPOCH="0")
    def test_bill_names_what_programs_contain(self):
        for name, programs, by_zig in (
                ("mien-0.1.0-py3-none-linux_x86_64.whl", True, False), ("mien-0.1.0-py3-none-manylinux_2_28_aarch64.whl", True, True),
                ("mien-0.1.0-py3-none-win_amd64.whl", True, True), ("mien_0.1.0_amd64.deb", True, False), ("mien-0.1.0.tar.gz", False, False)):
            file = self.folder / name
            file.write_bytes(b"")
            contained = {package["name"] for package in sbom.document("0.1.0", self.folder)["packages"]}
            self.assertEqual("CLI11" in contained, programs, name)
            self.assertEqual("libc++" in contained, by_zig, name)
            file.unlink()


class Sizes(unittest.TestCase):
    def test_page_is_what_the_script_writes(self):
        page = sizes.PAGE.read_text()
        table = page[page.index(sizes.BEGIN) + len(sizes.BEGIN):page.index(sizes.END)]
        self.assertEqual(sizes.written_table(sizes.read_table(table)), table)

    def test_chosen_targets(self):
        columns = {target: {} for target in sizes.TARGETS} | {"gcc": {"level 1": 1000}}
        self.assertEqual(sizes.chosen([], columns, check=True), ["gcc"])
        self.assertEqual(sizes.chosen([], columns, check=False), sizes.TARGETS)
        self.assertEqual(sizes.chosen(["macos-x64"], columns, check=True), ["macos-x64"])

    def test_differences(self):
        self.assertEqual(list(sizes.differences("gcc", {"level 1": 1000}, {"level 1": 1009})), [])
        self.assertEqual(len(list(sizes.differences("gcc", {"level 1": 1000}, {"level 1": 1011}))), 1)
        self.assertEqual(len(list(sizes.differences("gcc", {}, {"level 1": 1000}))), 1)


if __name__ == "__main__":
    unittest.main()
