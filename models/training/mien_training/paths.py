"""Folders: the repository, the data packs (MIEN_DATA), caches and runs (MIEN_CACHE)."""
import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def data():
    return Path(os.environ.get("MIEN_DATA", ROOT.parent / "shared/data"))


def cache():
    return Path(os.environ.get("MIEN_CACHE", Path.home() / ".cache/mien"))
