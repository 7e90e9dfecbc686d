#!/usr/bin/env python3
"""Prepares scripts/check/words.sh: writes the settings of cspell and textlint, and copies of the pages without code.

usage: words.py FOLDER FILE...
Terms come from docs/glossary.md, known words from there and from scripts/check/words.txt. Copies keep their line numbers.
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
INLINE_CODE = re.compile(r"`(?:[^`\n]|\n(?!\n))+`")
NOT_PROSE = [re.compile(pattern) for pattern in (r"<!--.*?-->", r"(?<=\])\([^)\n]*\)", r"https?://\S+", r"(?m)^    .*$", r"</?[a-z][^>\n]*>")]


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
    """The text with code, links' targets and comments blanked. A number stands for inline code, so that no word seems repeated."""
    blank = lambda match: re.sub(r"\S", " ", match.group())
    numbers = itertools.cycle(range(10, 100))
    number = lambda match: str(next(numbers)) + blank(match)[2:]
    text = INLINE_CODE.sub(number, FENCE.sub(blank, text))
    for pattern in NOT_PROSE:
        text = pattern.sub(blank, text)
    return text


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
        content = Path(file).read_text()
        copy = folder / "text" / file
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(prose(without_words_to_avoid(content) if Path(file) == GLOSSARY else content))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
