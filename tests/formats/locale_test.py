"""Tests of readers and writers in a locale that writes a half as 0,5 and a thousand as 1.000. usage: locale_test.py FORMATS_TEST"""
import os
import shutil
import subprocess
import sys
import tempfile

NAME = "de_DE.UTF-8"


def main():
    if not shutil.which("localedef"):
        print("skipped: localedef is not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", f"{folder}/{NAME}"], capture_output=True, text=True)
        if made.returncode > 1:  # 1: created, with warnings
            print("skipped: localedef cannot create the locale:", made.stderr.strip())
            return 77
        # The C library never frees data from `LOCPATH`, which counts as a leak.
        environment = {**os.environ, "LOCPATH": folder, "MIEN_TEST_LOCALE": NAME, "ASAN_OPTIONS": "detect_leaks=0"}
        return subprocess.run([sys.argv[1], "--gtest_brief=1"], env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
