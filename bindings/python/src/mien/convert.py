"""python -m mien.convert MODEL.onnx -o MODEL.mien: the converter of apps/convert/mien_convert. Needs the extra mien[convert]."""

from __future__ import annotations

import importlib
import importlib.util
from typing import Optional, Sequence


def main(arguments: Optional[Sequence[str]] = None) -> None:
    """Runs the command line; raises SystemExit with a message of one line if a file is rejected."""
    if importlib.util.find_spec("onnx") is None:
        raise SystemExit("mien.convert: needs Python's onnx: pip install 'mien[convert]'")
    importlib.import_module("mien._convert.onnx_to_mien").main(arguments)


if __name__ == "__main__":
    main()
