"""Tables as text: UTF-8 or UTF-16, separated by commas, semicolons or tabs, with positions for messages."""

import csv
import math

from .frame import FaceDataError

MAX_BYTES = 1 << 28


def decoded(data):
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif len(data) >= 4 and 0 in data[:2]:
        encoding = "utf-16-le" if data[1] == 0 else "utf-16-be"
    else:
        encoding = "utf-8-sig"
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        raise FaceDataError(f"byte {error.start}: not {encoding.upper().removesuffix('-SIG')} text") from None


def quoted(text):
    text = "".join(c if c.isprintable() else "?" for c in text)
    return f"'{text}'" if len(text) <= 40 else f"'{text[:37]}...'"


def _separator(line):
    outside = "".join(line.split('"')[::2])
    commas, semicolons, tabs = (outside.count(c) for c in ",;\t")
    return ";" if semicolons > max(commas, tabs) else "\t" if tabs > commas else ","


class Table:
    """Rows of a table with columns by name, in any case."""

    def __init__(self, text):
        self._lines = enumerate(text.split("\n"), 1)
        self.line, self.cells = 1, []
        self.separator = _separator(text.partition("\n")[0])
        if not self.next_row():
            raise FaceDataError("line 1: empty file")
        self.names = [name.strip() for name in self.cells]
        self.columns = {}
        for i, name in enumerate(self.names):
            if name and self.columns.setdefault(name.lower(), i) != i:
                raise self.error(f"duplicate column {quoted(name)}")

    def next_row(self):
        """False at the end. Empty lines are skipped."""
        for number, line in self._lines:
            self.line = number
            if line.strip(" \r"):
                self.cells = self._split(line.removesuffix("\r"))
                return True
        return False

    def _split(self, line):
        if '"' not in line:
            return line.split(self.separator)
        try:
            return next(csv.reader([line], delimiter=self.separator, strict=True))
        except csv.Error as error:
            raise self.error(str(error)) from None

    def error(self, what):
        return FaceDataError(f"line {self.line}: {what}")

    def has(self, name):
        return name.lower() in self.columns

    def check_width(self):
        if len(self.cells) != len(self.names):
            raise self.error(f"wrong number of cells (got {len(self.cells)}, expected {len(self.names)})")

    def text(self, name):
        """Empty if the column or the cell is missing."""
        i = self.columns.get(name.lower(), len(self.cells))
        return self.cells[i].strip() if i < len(self.cells) else ""

    def number(self, name):
        """None for an empty cell."""
        text = self.text(name)
        if not text:
            return None
        value = parsed(text if self.separator == "," else text.replace(",", ".", 1))
        if value is None:
            raise self.error(f"{self.names[self.columns[name.lower()]]}: {quoted(text)} is not a number")
        return value

    def all_numbers(self, names):
        """None unless all cells have a number."""
        values = [self.number(name) for name in names]
        return None if None in values else values


def parsed(text):
    """A finite number, or None. Python's underscores within numbers are no part of the formats."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) and "_" not in text else None
