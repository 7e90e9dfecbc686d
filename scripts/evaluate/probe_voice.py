#!/usr/bin/env python3
"""AudioNet's figures on validation data, to choose by; the product is judged by evaluate.py voice.

usage: probe_voice.py ENCODER.pt DECODERS.pt
"""
import argparse
from pathlib import Path

import evaluate_voice
from voice_model import Model


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoints", type=Path, nargs=2)
    print("\n".join(evaluate_voice.tables(evaluate_voice.figures(Model(*parser.parse_args().checkpoints, "val")))))


if __name__ == "__main__":
    main()
