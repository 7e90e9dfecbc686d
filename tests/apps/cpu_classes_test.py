"""Tiers are those of the CPU: mien-conformance where CPUID hides instruction sets (mask_cpuid.c).

usage: cpu_classes_test.py CONFORMANCE_PROGRAM MASK_LIBRARY
"""
import json
import os
import subprocess
import sys
import unittest

PROGRAM, MASK = sys.argv[1:3]
del sys.argv[1:]
UNAVAILABLE = 69  # exit status of the mask: CPUID cannot be trapped here, or the CPU is below the class


def run(cpu_class):
    environment = os.environ if cpu_class is None else os.environ | {"LD_PRELOAD": MASK, "MIEN_CPU_CLASS": cpu_class}
    command = [PROGRAM, "--filter", "pointwise", "--json", "-"]
    return subprocess.run(command, env=environment, capture_output=True, text=True)


def tiers(cpu_class):
    result = run(cpu_class)
    assert result.returncode == 0, result.stderr
    return set(json.loads(result.stdout)["tiers"])


class Classes(unittest.TestCase):
    def test_a_class_has_no_newer_tiers(self):
        whole = tiers(None)
        self.assertEqual({t for t in whole if not t.startswith(("avx512", "avxvnni"))}, tiers("avx2"))
        if "avxvnni" in whole:
            self.assertEqual({t for t in whole if not t.startswith("avx512")}, tiers("avx2+vnni"))
        if "avx512" in whole:
            self.assertEqual(whole, tiers("avx512"))

    def test_a_cpu_is_not_taken_for_a_class_above_it(self):
        whole = tiers(None)
        for cpu_class, tier in (("avx2+vnni", "avxvnni"), ("avx512", "avx512")):
            if tier not in whole:
                result = run(cpu_class)
                self.assertEqual(UNAVAILABLE, result.returncode)
                self.assertIn("lacks", result.stderr)

    def test_an_unknown_class_is_an_error(self):
        self.assertEqual(UNAVAILABLE, run("pentium").returncode)


if __name__ == "__main__":
    if run("avx2").returncode == UNAVAILABLE:
        print("SKIPPED: this CPU or kernel cannot trap CPUID")
        sys.exit(77)
    unittest.main()
