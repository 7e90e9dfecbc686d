"""Tests that help, manual page, completions and docs/cli.md have the same verbs and options.

usage: manners_test.py MIEN_PROGRAM DOCS
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

DOCS = sys.argv.pop(2)
PROGRAM = sys.argv.pop(1)
CLIP = os.path.join(DOCS, "..", "tests", "data", "demo.mp4")


def run(*arguments, **more):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60, **more)


def verbs():
    lines = run("--help").stdout.split("Subcommands:")[1].splitlines()
    return [line.split()[0] for line in lines if re.match(r"  \w", line)]


def options(verb):
    return sorted(set(re.findall(r"^\s+(?:-\w,)?(--?[a-z][-a-z]*)", run(verb, "--help").stdout.split("Options:")[1], re.M)) - {"--help", "-h"})


class Manners(unittest.TestCase):
    def test_every_verb_has_valid_examples(self):
        self.assertGreaterEqual(len(verbs()), 9)
        for verb in verbs():
            text = run(verb, "--help").stdout
            self.assertIn("Examples:\n  mien ", text, verb)
            for line in text.split("Examples:")[1].splitlines():
                words = line.split()
                if words[:1] == ["mien"] and words[1] == verb:
                    for option in re.findall(r"(?<= )--?[a-z][-a-z]*", line.split(" | ")[0].split(" && ")[0]):
                        self.assertIn(option, options(verb) + ["-l"], line)

    def test_the_documentation_has_every_option(self):
        with open(DOCS + "/cli.md") as file:
            documented = file.read()
        for verb in verbs():
            self.assertIn(f"mien {verb}", documented)
            for option in options(verb):
                self.assertIsNotNone(re.search(re.escape(option) + r"(?![-a-z])", documented), f"{verb} {option}")

    def test_the_manual_page_has_every_option(self):
        page = run("manual").stdout
        self.assertTrue(page.startswith(".TH MIEN 1"))
        for verb in verbs():
            section = page.split(f".SH MIEN {verb}\n")[1].split("\n.SH ")[0]
            for option in options(verb):
                self.assertIn("\\fB" + option.replace("-", "\\-") + "\\fR", section)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tascii", "-ww"], input=page, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_completions(self):
        script = run("completion", "bash").stdout
        complete = lambda *words: subprocess.run(
            ["bash", "-c", script + 'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _mien; printf "%s\\n" "${COMPREPLY[@]}"', "bash", *words],
            capture_output=True, text=True, check=True).stdout.split()
        self.assertEqual(complete("mien", "tra"), ["track"])
        self.assertEqual(complete("mien", "track", "--mo"), ["--mode", "--models"])
        self.assertEqual(complete("mien", "track", "--lod", ""), ["1", "2", "3", "4", "auto"])
        self.assertEqual(complete("mien", "completion", "z"), ["zsh"])
        for shell in ("zsh", "fish"):
            text = run("completion", shell).stdout
            if shutil.which(shell):
                subprocess.run([shell, "-n"], input=text, text=True, check=True)
            for verb in verbs():
                for option in options(verb):
                    self.assertIn(option if shell == "zsh" else (" -l " + option[2:] if option.startswith("--") else " -s " + option[1:]), text)

    def test_comparisons_as_json(self):
        with tempfile.TemporaryDirectory() as folder:
            a, b, page = (os.path.join(folder, name) for name in ("a.csv", "b.csv", "page.html"))
            for path, jaw in ((a, "0.5"), (b, "0.25")):
                with open(path, "w") as file:
                    file.write("t_ms,pitch_rad,yaw_rad,roll_rad,jawOpen" + (",tongueOut" if path == a else "") + "\n")
                    file.writelines(f"{i * 40},0,{0.1 * i},0,{jaw}" + (",0" if path == a else "") + "\n" for i in range(10))
            summary = json.loads(run("compare", a, b, "-o", page, "--json").stdout)
            self.assertEqual((summary["matched_frames"], summary["a"], summary["b"]["name"]),
                             (10, {"name": "a.csv", "frames": 10, "start_ms": 0.0, "last_ms": 360.0}, "b.csv"))
            self.assertEqual(list(summary["controls"]), ["jawOpen"], "controls of both files")
            self.assertEqual((summary["controls"]["jawOpen"]["mean_abs"], summary["controls"]["jawOpen"]["correlation"]), (0.25, None))
            self.assertEqual(summary["head"]["yaw"]["mean_abs_deg"], 0.0)
            self.assertTrue(os.path.exists(page))

    def test_a_neutral_face_as_json(self):
        source = os.path.join(DOCS, "..")
        if not shutil.which("ffmpeg") or not os.path.exists(os.path.join(source, "models", "basenet.mien")):
            self.skipTest("SKIPPED: ffmpeg or the weights are missing")
        with tempfile.TemporaryDirectory() as folder:
            clip, made = os.path.join(source, "tests", "data", "demo.mp4"), os.path.join(folder, "me.neutral")
            done = run("neutral", clip, "-o", made, "--json", "--models", os.path.join(source, "models"))
            levels = [1, 2, 3, 4] if os.path.exists(os.path.join(source, "models", "hifinet.mien")) else [1]
            self.assertEqual(json.loads(done.stdout), {"input": clip, "output": made, "levels": levels})
            self.assertEqual(done.stderr, "")

    def test_typing_errors_get_a_suggestion(self):
        # cspell:ignore lood trak
        for arguments, wanted in ((["trak"], "mien: unknown verb 'trak'; did you mean 'track'?\n"), (["cmopare", "a"], "'compare'"),
                                  (["track", "--lood", "3", "x"], "mien: track: unknown option '--lood'; did you mean '--lod'?\n"),
                                  (["--verson"], "'--version'"), (["xyzzy"], "mien: unknown verb 'xyzzy'\n"),
                                  ([], "mien: a verb is required; `mien --help` lists them\n"), (["track", "a", "b"], "mien: unexpected argument 'b'\n"),
                                  (["track", "--lod", "1", "--lod", "2"], "mien: --lod: may be given only once\n")):
            done = run(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(wanted, done.stderr)
        self.assertEqual(run("convert", "/nowhere.csv", "-", "--quiet").returncode, 3)

    def test_a_closed_standard_output_is_not_an_error(self):
        rows = "t_ms,jawOpen\n" + "".join(f"{i},0.5\n" for i in range(100000))
        command = f"'{PROGRAM}' convert - - --to csv --quiet | head -1; echo ${{PIPESTATUS[0]}}"
        done = subprocess.run(["bash", "-c", command], input=rows, capture_output=True, text=True, timeout=60)
        self.assertEqual((done.stdout.splitlines()[-1], done.stderr), ("0", ""))
        full = subprocess.run(["bash", "-c", f"'{PROGRAM}' convert - - --to csv --quiet >/dev/full"], input=rows, capture_output=True, text=True)
        self.assertEqual(full.returncode, 7)
        self.assertIn("standard output: cannot be written", full.stderr)

    def test_failed_output_is_reported(self):
        """A closed reader is not an error; a full disk is."""
        source = os.path.join(DOCS, "..")
        models = os.path.join(source, "models")
        with tempfile.TemporaryDirectory() as folder:
            place = lambda name: os.path.join(folder, name)
            with open(place("a.csv"), "w") as file:
                file.write("t_ms,jawOpen\n0,0\n40,0.5\n")
            mini = os.path.join(source, "apps", "conformance", "golden", "mini.mien")
            compare = ["compare", place("a.csv"), place("a.csv"), "-o", place("page.html")]
            printing = [["--help"], ["--version"], ["track", "--help"], ["manual"], ["completion", "bash"], ["inspect", mini],
                        ["inspect", mini, "--json"], compare, [*compare, "--json"]]
            if os.path.exists(os.path.join(models, "basenet.mien")):
                printing.append(["bench", "--model", "basenet_pose_decoder", "--tier", "ref", "--models", models])
                if shutil.which("ffmpeg"):
                    clip = os.path.join(source, "tests", "data", "demo.mp4")
                    os.mkdir(place("in"))
                    os.symlink(clip, place("in/a.mp4"))
                    batch = ["track", place("in"), "--out", place("out"), "--duration", "0.1", "--lod", "1", "--models", models]
                    printing += [batch, [*batch, "--json"], ["neutral", clip, "-o", place("me"), "--json", "--models", models]]
            for arguments in printing:
                with open("/dev/full", "w") as full:
                    done = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=120)
                self.assertEqual(done.returncode, 7, arguments)
                self.assertIn("mien: standard output: cannot be written: ", done.stderr, arguments)
                reader, writer = os.pipe()
                os.close(reader)
                with open(writer, "w") as gone:
                    done = subprocess.run([PROGRAM, *arguments], stdout=gone, stderr=subprocess.PIPE, text=True, timeout=120)
                self.assertEqual((done.returncode, [line for line in done.stderr.splitlines() if line.startswith("mien:")]), (0, []), arguments)

    def test_invalid_values_name_what_is_expected(self):
        for arguments, wanted in ((["track", "x", "--lod", "high"], "--lod: invalid value (got 'high', expected 1, 2, 3, 4 or auto)"),
                                  (["track", "x", "--fov", "200"], "--fov: invalid value (got '200', expected a number from 1 to 170)"),
                                  (["track", "x", "--duration", "0"], "--duration: invalid value (got '0', expected a number above 0)"),
                                  (["track", "x", "--max-faces", "1.5"], "--max-faces: invalid value (got '1.5', expected an integer from 1 to 8)"),
                                  (["convert", "a", "b", "--face", "x"], "--face: invalid value (got 'x', expected an integer)"),
                                  (["track", CLIP, "--tier", "x"], "--tier: unknown tier (got 'x', expected one of ref ")):
            done = run(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn("mien: " + wanted, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def test_choices_and_missing_values(self):
        """For every option with a value."""
        tried = 0
        for verb in verbs():
            for option, value in re.findall(r"^\s+(--?[a-z][-a-z]*) ([A-Z]+|[a-z0-9|-]+\|[a-z0-9|-]+) ", run(verb, "--help").stdout, re.M):
                tried += 1
                done = run(verb, option)
                self.assertEqual((done.returncode, done.stderr), (2, f"mien: {option}: value missing (expected {value})\n"))
                if "|" in value and "csv" not in value:  # --format and others fail later, with the formats
                    *choices, last = value.split("|")
                    done = run(verb, option, "wrong")
                    self.assertIn(f"mien: {option}: invalid value (got 'wrong', expected {', '.join(choices)} or {last})", done.stderr)
        self.assertGreaterEqual(tried, 60)

    def test_invalid_numbers(self):
        """For every option with a number."""
        tried = 0
        for verb in verbs():
            for option in re.findall(r"^\s+(--[a-z][-a-z]*) (?:N|X|S|MS|MB|DEGREES)\b", run(verb, "--help").stdout, re.M):
                tried += 1
                for number in ("nan", "-nan", "NAN", "inf", "-inf", "1e999"):
                    done = run(verb, f"{option}={number}")
                    self.assertEqual(done.returncode, 2, (verb, option, number))
                    self.assertRegex(done.stderr, f"{option}\\b.*{number}", (verb, option, number))
        self.assertGreaterEqual(tried, 20)


if __name__ == "__main__":
    unittest.main()
