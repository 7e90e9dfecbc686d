#!/usr/bin/env python3
"""Runs the tests of a module here, or the self-test of a training or evaluation module.

usage: run.py MODULE      exit 77: something it needs is missing here
"""
import importlib
import sys
import unittest
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
sys.path[:0] = [str(SCRIPTS / "train"), str(SCRIPTS / "evaluate")]
try:
    module = importlib.import_module(sys.argv[1])
except ModuleNotFoundError as missing:
    print("skipped: no Python module", missing.name, "here")
    sys.exit(77)
if hasattr(module, "self_test"):
    module.self_test()
else:
    unittest.main(module=module, argv=sys.argv[:1])
