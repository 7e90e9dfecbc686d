#!/usr/bin/env python3
"""Runs the self-test of a training or evaluation module.  usage: self_test.py MODULE      exit 77: something is missing here"""
import importlib
import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
sys.path[:0] = [str(SCRIPTS / "train"), str(SCRIPTS / "evaluate")]
try:
    module = importlib.import_module(sys.argv[1])
except ModuleNotFoundError as missing:
    print("skipped: no Python module", missing.name, "here")
    sys.exit(77)
module.self_test()
