"""Converts ONNX files to one weight file of mien with a network for each, or names the unsupported node.
docs/convert.md has the details.

usage: python3 -m mien_convert MODEL.onnx... -o MODEL.mien [--name NAME]... [--shape [INPUT:]1,3,64,64]...
       [--time-axis N|none] [--any-size]
       [--value INPUT=NUMBER]... [--fp16-only] [--int8 FOLDER [--int8-error E]]
"""
import argparse
import re
import sys
from pathlib import Path

from .errors import Refused, in_a_line, require

try:
    from .graph import converted
    from .int8 import choose_int8, read_samples
    from .model import Graph
    from .precision import kept_precise
    from .weight_file import MienFile
except ModuleNotFoundError as missing:
    sys.exit(f"onnx_to_mien.py: no Python module {missing.name!r} here; scripts/setup.sh convert installs it")


def network_name(stem):
    """The nearest name that the format allows."""
    return re.sub(r"[^a-z0-9_./]", "_", stem.lower())[:63]


def shape_of(text):
    """[INPUT:]1,3,64,64"""
    name, _, numbers = text.rpartition(":")
    if not re.fullmatch(r"\d+(,\d+)*", numbers) or "0" in numbers.split(","):
        raise argparse.ArgumentTypeError(f"{text!r} is no shape")
    return name, [int(n) for n in numbers.split(",")]


def value_of(text):
    """INPUT=NUMBER"""
    name, _, number = text.rpartition("=")
    try:
        return name, float(number)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not INPUT=NUMBER") from error


def error_of(text):
    if not re.fullmatch(r"\d*\.?\d+", text) or not 0 < float(text) <= 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not in 0 .. 1")
    return float(text)


def time_axis_of(text):
    if text == "none":
        return -1
    if text.isdigit():
        return int(text)
    raise argparse.ArgumentTypeError(f"{text!r} is neither an axis nor 'none'")


def add_network(file, path, name, options):
    graph = Graph(Path(path))
    for given, number in options.value:
        require(given in graph.inputs, f"no input {given!r}; there is {', '.join(graph.inputs)}")
        graph.fix(given, number)
    first = next(iter(graph.inputs))
    shapes = {given or first: shape for given, shape in options.shape}
    for given in shapes:
        require(given in graph.inputs, f"no input {given!r}; there is {', '.join(graph.inputs)}")
    conversion = converted(graph, shapes, options.time_axis)
    network = conversion.network()
    int8 = None
    if options.int8:
        require(not conversion.t.steps, "--int8: the network has a state")
        int8 = choose_int8(network, read_samples(options.int8, conversion.source.shape), options.int8_error)
    precision = kept_precise(network, bool(conversion.t.steps), not options.fp16_only)
    net = file.network(name, conversion.source.shape, any_size=options.any_size)
    network.write(net)
    time = f", time axis {conversion.guess.time_axis}" if conversion.t.steps else ""
    file.metadata[f"{name[:58]}.onnx"] = f"{Path(path).name[:200]}, opset {graph.opset}, {graph.producer[:200]}{time}"
    return conversion, network, [*notes_of(precision), *int8_notes(int8)]


def report(path, name, conversion, network, notes):
    h, w, c = conversion.source.shape
    over_time = f", one step of its time axis {conversion.guess.time_axis} a run" if conversion.t.steps else ""
    print(f"{path} -> network {name}: input {h}x{w}x{c}{over_time}, {len(network.layers)} layers")
    for output, position in conversion.positions.items():
        print(f"  output {position}: {output}, {'x'.join(map(str, network.outputs[position].shape))}")
    for state, _ in conversion.state_names.values():
        print(f"  state {state} stays inside")
    for note in dict.fromkeys([*conversion.t.notes, *notes]):
        print(f"  note: {note}")


def notes_of(precision):
    if precision.too_large:
        yield "too large to estimate the effect of rounding weights to fp16 on the outputs"
    if precision.kept:
        names = dict.fromkeys(layer.node for layer in precision.kept)
        cost = f"+{precision.more_bytes} bytes, +{precision.more_work / 1e6:.1f} million multiplications"
        yield f"kept precise by a second layer each ({cost}): {', '.join(names)}"
        yield f"estimated error: {precision.after:.1e} of the largest value; {precision.before:.1e} with --fp16-only"
    elif precision.before is not None:
        yield f"estimated error: {precision.before:.1e} of the largest value"


def int8_notes(int8):
    if int8 is not None:
        yield (f"8 bits in {len(int8.layers)} of {len(int8.candidates)} layers of inverted residual blocks, "
               f"{100 * int8.share:.1f} % of all multiplications; estimated error of the outputs: {int8.error:.1e} of "
               "their deviation")


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="+", metavar="MODEL.onnx")
    parser.add_argument("-o", "--output", required=True, metavar="MODEL.mien")
    parser.add_argument("--name", action="append", default=[],
                        help="name of a network, once per ONNX file; default: the file's name")
    parser.add_argument("--shape", action="append", default=[], type=shape_of,
                        help="[INPUT:]N,N,...: shape of an input (default: the first) with open dimensions")
    parser.add_argument("--value", action="append", default=[], type=value_of,
                        help="INPUT=NUMBER: makes an input a constant, for example a sampling rate")
    parser.add_argument("--time-axis", type=time_axis_of,
                        help="time axis of the first input, or none; default: detected")
    parser.add_argument("--any-size", action="store_true", help="the networks also run on larger maps")
    parser.add_argument("--fp16-only", action="store_true",
                        help="adds no second layers where rounding to fp16 costs accuracy")
    parser.add_argument("--int8", metavar="FOLDER",
                        help="lets layers compute with 8 bits, chosen with the sample inputs (*.npy) of a folder")
    parser.add_argument("--int8-error", type=error_of, default=0.02, metavar="E",
                        help="largest error of an output with --int8, relative to its deviation; default: 0.02")
    options = parser.parse_args(arguments)
    file = MienFile()
    for i, path in enumerate(options.models):
        name = options.name[i] if i < len(options.name) else network_name(Path(path).stem)
        try:
            report(path, name, *add_network(file, path, name, options))
        except (Refused, ValueError, OSError) as refusal:
            sys.exit(f"onnx_to_mien.py: {path}: {in_a_line(refusal)}")
        except MemoryError:
            sys.exit(f"onnx_to_mien.py: {path}: out of memory")
    try:
        file.write(options.output)
    except (ValueError, OSError) as refusal:
        sys.exit(f"onnx_to_mien.py: {options.output}: {refusal}")
