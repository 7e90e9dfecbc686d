#!/usr/bin/env python3
"""Prepares scripts/check/words.sh: writes the settings of cspell and textlint, and copies without code: of pages their
prose, of sources their comments and messages.

usage: words.py FOLDER FILE...
Phrases to avoid come from scripts/check/avoid.txt (TERM | PHRASE | ...), known words from docs/glossary.md and
scripts/check/words.txt. Copies keep their line numbers.
"""
import itertools
import json
import re
import sys
from pathlib import Path

GLOSSARY = Path("docs/glossary.md")
WORDS = Path("scripts/check/words.txt")
AVOID = Path("scripts/check/avoid.txt")
NOT_WORDS = [r"\+git\w+", r"\b\w*[_\d]\w*\b", r"\b[0-9a-f]{7,40}\b", r"\bk[A-Z]\w*\b", r"(?<!\w)--?[A-Za-z]\w*",
             r"\blib[a-z]+-\S+", r"[\w./-]+\.(sh|py|mjs|cmake|so)\b", r"~?/\.?\w[\w./]+"]
FENCE = re.compile(r"(?ms)^[ ]*```.*?^[ ]*```[ ]*$")
# Group 1 is a comment or a docstring, group 2 a string.
STRING = r"\"(?:\\.|[^\"\\\n])*\""
C_LIKE = re.compile(
    rf"(//[^\n]*|/\*.*?\*/)|(R\"(\w*)\(.*?\)\3\"|{STRING}|(?<!\w)'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`)", re.S)
PYTHON = re.compile(
    rf"((?<!\S)#(?![a-z])[^\n]*|(?m:^)[ ]*\"{{3}}.*?\"{{3}})|(\"{{3}}.*?\"{{3}}|{STRING}|'(?:\\.|[^'\\\n])*')", re.S)
SCRIPT = re.compile(rf"((?<!\S)#(?![a-z])[^\n]*)|({STRING}|'[^'\n]*')")
SOURCES = {
    (".h", ".hpp", ".c", ".cpp", ".inc", ".js", ".mjs", ".ts", ".cs", ".java", ".kt", ".rs", ".swift"): C_LIKE,
    (".py",): PYTHON,
    (".sh", ".cmake", "CMakeLists.txt"): SCRIPT,
}
COLUMNS = re.compile(r"(?<=\S) {2,}(?=\S)")  # of a table, or between code and comment
MESSAGE = re.compile(r"[A-Za-z]{2,},? [a-z]{2,},? [a-z]{2,}")
PLACEHOLDER = re.compile(r"%[-+.*\d]*[a-z]+|\$?\{[^{}\n]*\}|\$\w+")
INLINE_CODE = re.compile(r"`(?:[^`\n]|\n(?!\n))+`|@param\S* +\w+")
CELL_BORDER = re.compile(r"(?<!\\)\|")
INDENTED_CODE = re.compile(r"(?m)^    .*$")
NOT_PROSE = [re.compile(pattern)
             for pattern in (r"<!--.*?-->", r"(?<=\])\([^)\n]*\)", r"https?://\S+", r"</?[a-z][^>\n]*>",
                             r"[\w.-]+\.so\b")]


def terms_of(glossary):
    """First cells of the rows."""
    return re.findall(r"(?m)^\| ([^|\n]+) \|", glossary)


def terminology(lines):
    """[pattern, term] for each phrase to avoid."""
    terms = {}
    for line in lines:
        term, *phrases = line.split(" | ")
        for phrase in phrases:
            terms.setdefault(phrase, []).append(term)
    if not terms:
        raise SystemExit(f"{AVOID}: no phrases")
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


def blanked(code):
    """Spaces of the same length after a full stop, so that the texts before and after the code are two sentences."""
    return re.sub(r"\S(.*)", lambda match: "." + re.sub(r"\S", " ", match.group(1)), code, count=1, flags=re.S)


def without(pattern, text):
    return re.sub(pattern, lambda mark: " " * len(mark.group()), text)


def text_of(match):
    """A comment without its marks, or a message of one line without its quotes and placeholders."""
    comment, string = match.group(1, 2)
    if comment:
        return without(r"^\s*(//+!?|#+|/\*+|\"{3})|(\*/|\"{3})$|(?m:^\s*\*(?= ))", comment)
    if MESSAGE.search(string) and "\n" not in string:
        unquoted = without(r"^\w*[\"'`]+|[\"'`]+$|\\.", string)
        return PLACEHOLDER.sub(lambda code: "0" * len(code.group()), unquoted)
    return blanked(string)


def comments_and_messages(text, pattern):
    """The text with everything else blanked."""
    kept, end = [], 0
    for match in pattern.finditer(text):
        kept += [blanked(text[end:match.start()]), text_of(match)]
        end = match.end()
    return "".join(kept) + blanked(text[end:])


def copy_of(file, content):
    """(name, text) of the copy for the tools, which read Markdown and plain text."""
    for endings, pattern in SOURCES.items():
        if file.endswith(endings):
            text = prose(comments_and_messages(content, pattern))
            return file + ".txt", COLUMNS.sub(lambda gap: " ." + gap.group()[2:], text)
    content = INDENTED_CODE.sub(lambda match: re.sub(r"\S", " ", match.group()), content)
    # The tools separate words by spaces: |98 %|98 %| repeats a number, not a word.
    return file, CELL_BORDER.sub(" | ", prose(content))


def main(folder, files):
    terms = " ".join(terms_of(GLOSSARY.read_text()))
    known = set(WORDS.read_text().split()) | set(re.findall(r"[A-Za-z]+", terms))
    spelling = {"version": "0.2", "language": "en-GB", "words": sorted(known), "useGitignore": False,
                "dictionaries": ["softwareTerms", "cpp", "python", "typescript", "node", "companies", "filetypes"],
                "ignoreRegExpList": NOT_WORDS}
    rules = {"rules": {"terminology": {"defaultTerms": False, "terms": terminology(AVOID.read_text().splitlines())}}}
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
