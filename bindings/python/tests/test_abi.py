"""The package declares the C interface as the header does: every struct's layout, every function, every status."""
import ctypes
import re
import shutil
import subprocess
import sys
from pathlib import Path

import mien
import pytest
from conftest import REPOSITORY
from mien import _library, errors

HEADER = (REPOSITORY / "include/mien/mien.h").read_text()


@pytest.fixture(scope="module")
def facts():
    """The facts of bindings/c_api.py by kind, {name: value}."""
    if shutil.which("clang") is None:
        pytest.skip("clang is not installed")
    declared = {}
    for line in subprocess.run([sys.executable, REPOSITORY / "bindings/c_api.py"], check=True, capture_output=True, text=True).stdout.splitlines():
        kind, name, value = line.split()
        declared.setdefault(kind, {})[name] = int(value)
    return declared


def test_struct_layouts_match_the_header(facts):
    fields = {f"{name}.{field[0]}": getattr(struct, field[0]).offset for name, struct in _library.STRUCTS.items() for field in struct._fields_}
    assert fields == facts["field"]
    assert {name: ctypes.sizeof(struct) for name, struct in _library.STRUCTS.items()} == facts["struct"]


def test_functions_match_the_header(facts):
    for name, (_, arguments) in _library.FUNCTIONS.items():
        assert len(arguments) == facts["function"][name], name


def test_every_status_has_its_exception():
    numbers = {int(n) for n in re.findall(r"MIEN_ERROR_\w+ = (-\d+)", HEADER)}
    assert numbers == set(errors.BY_STATUS)
    for number, kind in errors.BY_STATUS.items():
        assert str(kind()) != "unknown status"
        with pytest.raises(kind) as caught:
            errors.check(number)
        assert caught.value.status == number
    with pytest.raises(mien.MienError, match="unknown status"):
        errors.check(-999)
    errors.check(0)


def test_constants():
    defined = dict(re.findall(r"#define (MIEN_\w+) (\d+)\b", HEADER))
    assert defined["MIEN_CONTROL_COUNT"] == str(_library.CONTROL_COUNT)
    assert defined["MIEN_LANDMARK_COUNT"] == str(_library.LANDMARK_COUNT)
    assert defined["MIEN_NEUTRAL_BYTES"] == str(_library.NEUTRAL_BYTES)
    assert mien.__version__ == "0.1.0"


@pytest.mark.parametrize("kind, prefix", [(mien.Control, "MIEN_CONTROL_"), (mien.LandmarkGroup, "MIEN_LANDMARKS_")])
def test_enums_match_the_header(facts, kind, prefix):
    expected = {name[len(prefix) :]: number for name, number in facts["enum"].items() if name.startswith(prefix)}
    assert {member.name: member.value for member in kind} == expected


def test_landmark_groups_cover_all_landmarks():
    indices = [index for group in mien.LandmarkGroup for index in group.landmarks]
    assert indices == list(range(mien.LANDMARK_COUNT))


def test_the_package_is_small():
    files = {path: path.stat().st_size for path in Path(mien.__file__).parent.rglob("*") if path.is_file() and "__pycache__" not in str(path)}
    program = sum(size for path, size in files.items() if path.name in ("mien", "mien.exe", "third_party.txt"))
    assert sum(files.values()) - program < 6.05e6, "library and weights; the layers of weight format 1.2 took 0.02 MB"
    assert program < 3.6e6, "the program, which track_file runs, with its licences; test.sh limits the wheel, what a user downloads"
