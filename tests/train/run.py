#!/usr/bin/env python3
"""Runs the tests of a module here.

usage: run.py MODULE      exit status 77: a Python module is missing
"""
import importlib
import sys
import unittest

try:
    module = importlib.import_module(sys.argv[1])
except ModuleNotFoundError as missing:
    if (missing.name or "").startswith("mien_"):
        raise
    print("skipped: no Python module", missing.name)
    sys.exit(77)
unittest.main(module=module, argv=sys.argv[:1])
