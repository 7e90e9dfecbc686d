#!/usr/bin/env python3
"""Prepares scripts/check/words.sh: writes the settings of cspell and textlint, and copies without code: of pages their
prose, of sources their comments.

usage: words.py FOLDER FILE...
Terms come from docs/glossary.md, known words from there and from scripts/check/words.txt. Copies keep their line
numbers.
"""
import itertools
import json
import re
import sys
from pathlib import Path

GLOSSARY = Path("docs/glossary.md")
WORDS = Path("scripts/check/words.txt")
IN_CODE_FONT = re.compile(r"`([^`]+)`")
FENCE = re.compile(r"(?ms)^[ ]*```.*?^[ ]*```[ ]*$")
COMMENTS = {(".h", ".hpp", ".c", ".cpp", ".inc", ".js", ".mjs", ".ts"): re.compile(r"(?<![:\"'\w/])//[^\n]*|/\*.*?\*/",
                                                                                   re.S),
            (".py", ".sh", ".cmake", "CMakeLists.txt"): re.compile(r"(?m)(?<![^\s])#[^\n]*|\"{3}.*?\"{3}", re.S)}
INLINE_CODE = re.compile(r"`(?:[^`\n]|\n(?!\n))+`")
INDENTED_CODE = re.compile(r"(?m)^    .*$")
NOT_PROSE = [re.compile(pattern)
             for pattern in (r"<!--.*?-->", r"(?<=\])\([^)\n]*\)", r"https?://\S+", r"</?[a-z][^>\n]*>")]


def glossary_rows(text):
    """(term, meaning, words to avoid) of each row."""
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("| ") else []
        if len(cells) == 3 and cells[0] != "term":
            yield cells


def terminology(rows):
    """[pattern, term] for each phrase that the glossary rules out everywhere."""
    terms = {}
    for term, _, avoid in rows:
        for phrase in IN_CODE_FONT.findall(avoid):
            terms.setdefault(phrase, []).append(term)
    if not terms:
        raise SystemExit(f"{GLOSSARY}: no words in code font")
    return [[rf"\b{re.escape(phrase)}\b", " or ".join(alternatives)] for phrase, alternatives in terms.items()]


def prose(text):
    """The text with code, links' targets and comments blanked. A number stands for inline code, so that no word seems
    repeated."""
    blank = lambda match: re.sub(r"\S", " ", match.group())
    numbers = itertools.cycle(range(10, 100))
    number = lambda match: str(next(numbers)) + blank(match)[2:]
    text = INLINE_CODE.sub(number, FENCE.sub(blank, text))
    for pattern in NOT_PROSE:
        text = pattern.sub(blank, text)
    return text


def comments(text, pattern):
    """The text with everything but comments blanked."""
    kept, end = [], 0
    for match in pattern.finditer(text):
        kept += [re.sub(r"\S", " ", text[end:match.start()]),
                 re.sub(r"^(//+|#+|/\*+)|\*/$|(?m:^\s*\*(?= ))", lambda m: " " * len(m.group()), match.group())]
        end = match.end()
    return "".join(kept) + re.sub(r"\S", " ", text[end:])


def copy_of(file, content):
    """(name, text) of the copy for the tools, which read Markdown and plain text."""
    for endings, pattern in COMMENTS.items():
        if file.endswith(endings):
            return file + ".txt", prose(comments(content, pattern))
    content = INDENTED_CODE.sub(lambda match: re.sub(r"\S", " ", match.group()), content)
    return file, prose(without_words_to_avoid(content) if Path(file) == GLOSSARY else content)


def without_words_to_avoid(text):
    return re.sub(r"(?m)^(\|[^|\n]*\|[^|\n]*\|)[^|\n]*\|$", r"\1 |", text)


def main(folder, files):
    text = GLOSSARY.read_text()
    rows = list(glossary_rows(text))
    known = set(WORDS.read_text().split()) | set(re.findall(r"[A-Za-z]+", " ".join(term for term, _, _ in rows)))
    spelling = {"version": "0.2", "language": "en-GB", "words": sorted(known), "useGitignore": False,
                "dictionaries": ["softwareTerms", "cpp", "python", "typescript", "node", "companies", "filetypes"],
                "ignoreRegExpList": [r"\+git\w+", r"\b\w*[_\d]\w*\b", r"\b[0-9a-f]{7,40}\b"]}
    rules = {"rules": {"terminology": {"defaultTerms": False, "terms": terminology(rows)}}}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cspell.json").write_text(json.dumps(spelling, indent=2))
    (folder / ".textlintrc.json").write_text(json.dumps(rules, indent=2))
    for file in files:
        name, text = copy_of(file, Path(file).read_text())
        copy = folder / "text" / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
