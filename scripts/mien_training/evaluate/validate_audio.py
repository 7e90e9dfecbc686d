"""AudioNet's figures on validation data, to select checkpoints; `mien_training.evaluate audio` uses test data.

usage: python3 -m mien_training.evaluate.validate_audio ENCODER.pt DECODERS.pt
"""
import argparse
from pathlib import Path

from mien_training.evaluate import evaluate_audio
from mien_training.evaluate.audio_model import Model


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoints", type=Path, nargs=2)
    print("\n".join(evaluate_audio.tables(evaluate_audio.figures(Model(*parser.parse_args().checkpoints, "val")))))


if __name__ == "__main__":
    main()
