"""Tests of scripts/package/amalgamate.py on small sources.

usage: amalgamate_test.py
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "scripts/package"))
import amalgamate  # noqa: E402


def lines_by_condition(text):
    """Each line with the stack of the conditions around it."""
    stack, found = [], []
    for line in text.splitlines():
        if line.startswith("#if"):
            stack.append(line)
        elif line.startswith("#endif"):
            stack.pop()
        else:
            found.append((line, tuple(stack)))
    return found


class Includes(unittest.TestCase):
    def joined(self, **files):
        """The amalgamation of main.cpp; `files` maps stems to texts, `main` to that of main.cpp."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for stem, text in files.items():
                (root / (stem + (".cpp" if stem == "main" else ".h"))).write_text(text)
            text = amalgamate.Text(root, {"any.h": "one.h"})
            text.add(root / "main.cpp", None)
            return text

    def test_a_header_may_replace_another(self):
        text = self.joined(main='#include "any.h"\n', any="int any;\n", one="int one;\n")
        self.assertIn("int one;", text.lines)
        self.assertNotIn("int any;", text.lines)

    def test_unconditional_includes_move_to_the_front(self):
        text = self.joined(main='#include "a.h"\n#include <cmath>\n', a="#pragma once\n#include <cmath>\nint a;\n")
        self.assertEqual(text.system, ["#include <cmath>"])
        self.assertNotIn("#include <cmath>", text.lines)

    def test_conditional_include_stays(self):
        text = self.joined(main="#ifdef X86\n#include <cpuid.h>\n#endif\n")
        self.assertEqual(text.system, [])
        self.assertEqual(text.lines[1:], ["#ifdef X86", "#include <cpuid.h>", "#endif"])

    def test_indented_conditions_count(self):
        text = self.joined(main="#ifdef A\n#  if B\n#  endif\n#include <cpuid.h>\n#endif\n")
        self.assertEqual(text.system, [])

    def test_includes_of_a_conditional_header_stay(self):
        text = self.joined(main='#ifdef X86\n#include "outer.h"\n#endif\n', outer='#pragma once\n#include "inner.h"\n',
                           inner="#pragma once\n#include <cpuid.h>\n")
        self.assertEqual(text.system, [])
        conditions = dict(lines_by_condition("\n".join(text.lines)))
        self.assertEqual(conditions["#include <cpuid.h>"][0], "#ifdef X86")

    def test_header_of_two_conditions_is_in_both_and_guarded(self):
        main = '#ifdef A\n#include "h.h"\n#endif\n#ifdef B\n#include "h.h"\n#endif\n#include "h.h"\n#include "h.h"\n'
        text = self.joined(main=main, h="#pragma once\nint h;\n")
        outer = [stack for line, stack in lines_by_condition("\n".join(text.lines)) if line == "int h;"]
        self.assertEqual(outer, [("#ifdef A", "#ifndef MIEN_H_H"), ("#ifdef B", "#ifndef MIEN_H_H"), ("#ifndef MIEN_H_H",)])


class Library(unittest.TestCase):
    def test_headers_of_one_architecture_are_conditional(self):
        with tempfile.TemporaryDirectory() as folder:
            sys.argv = ["amalgamate.py", "-o", folder]
            amalgamate.main()
            for path in sorted(pathlib.Path(folder).glob("*.cpp")):
                for line, stack in lines_by_condition(path.read_text()):
                    if line in ("#include <cpuid.h>", "#include <sys/auxv.h>", "#include <immintrin.h>", "#include <arm_neon.h>",
                                "#include <wasm_simd128.h>", "#include <xmmintrin.h>"):
                        self.assertTrue(stack, f"{path.name}: {line}")

    def test_headers_are_found_with_and_without_an_include_path(self):
        with tempfile.TemporaryDirectory() as folder:
            sys.argv = ["amalgamate.py", "-o", folder + "/mien_sources"]
            amalgamate.main()
            for text, options in (('#include "mien_sources/mien.hpp"', []), ("#include <mien/mien.hpp>", ["-Imien_sources"]),
                                  ("#include <mien/mien.h>\n#include <mien.h>", ["-Imien_sources"])):
                app = text + "\nint main() { return mien_version_api() == MIEN_API_VERSION ? 0 : 1; }\n"
                done = subprocess.run([os.environ.get("CXX", "c++"), "-std=c++20", "-fsyntax-only", *options, "-x", "c++", "-"],
                                      input=app, text=True, capture_output=True, cwd=folder)
                self.assertEqual((done.returncode, done.stderr), (0, ""), text)


if __name__ == "__main__":
    unittest.main()
