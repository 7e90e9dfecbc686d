#!/usr/bin/env python3
"""Fuzzes apps/convert/mien_convert with atheris: any file must be converted or rejected in one line.
scripts/fuzz_convert.sh

usage: onnx_converter.py --seeds FOLDER                      writes the graphs of tests/convert/*_cases.py there
       onnx_converter.py [libFuzzer's options] FOLDER...
"""
import contextlib
import functools
import io
import operator
import random
import resource
import sys
import tempfile
from pathlib import Path

import atheris
import numpy as np
import onnx

with atheris.instrument_imports(include=["mien_convert"]):
    from mien_convert import errors, graph, onnx_to_mien
    from mien_convert.constants import FUNCTIONS
    from mien_convert.operators import OPERATORS

MEMORY = 1 << 30  # more for a small file means that its sizes were not checked

# A sixteenth of the real limits, because the largest maps take seconds each and reach no more code than smaller ones.
errors.MAX_NUMBERS >>= 4
graph.MAX_TOTAL_NUMBERS >>= 4

OPERATOR_NAMES = sorted({*OPERATORS, *FUNCTIONS, "Constant", "If", "Sin"})
NUMBERS = (0, 1, 2, 3, 4, 7, 15, 16, 64, 255, -1, -2, 1 << 20, 1 << 31, (1 << 31) - 1, -(1 << 31),
           1 << 40, (1 << 63) - 1, -(1 << 63))
TYPES = range(17)


class Edits:
    """Changes to a model after which it is still a model, unlike random changes to its bytes."""

    def __init__(self, model, choice):
        self.graph, self.opsets, self.choice = model.graph, model.opset_import, choice

    def one(self):
        edits = [self.dimension, self.attribute, self.attribute, self.node, self.node, self.inputs, self.inputs,
                 self.weights, self.opset]
        # there is nothing of the kind, or the number does not fit
        with contextlib.suppress(ValueError, IndexError, TypeError):
            self.choice.choice(edits)()

    def any_of(self, repeated):
        return repeated[self.choice.randrange(len(repeated))]

    def number(self):
        return self.choice.choice(NUMBERS)

    def names(self):
        return [name for node in self.graph.node
                for name in (*node.input, *node.output)] + [x.name for x in self.graph.input] + [""]

    def changed(self, numbers):
        at = self.choice.randrange(len(numbers) + 1)
        if at == len(numbers):
            numbers.append(self.number())
        elif self.choice.random() < 0.2:
            del numbers[at]
        else:
            numbers[at] = self.number()

    def dimension(self):
        shape = self.any_of(self.graph.input).type.tensor_type.shape
        kind = self.choice.randrange(4)
        if kind == 0:
            shape.dim.add().dim_value = self.number()
        elif kind == 1:
            del shape.dim[self.choice.randrange(len(shape.dim))]
        elif kind == 2:
            self.any_of(shape.dim).dim_param = "n"
        else:
            self.any_of(shape.dim).dim_value = self.number()

    def attribute(self):
        attribute = self.any_of(self.any_of(self.graph.node).attribute)
        kind = self.choice.randrange(6)
        if kind == 0:
            attribute.type = self.choice.randrange(12)
        elif kind == 1:
            attribute.name = self.choice.choice(("pads", "axis", "axes", "strides", "group", "value", "perm", "mode",
                                                 "to"))
        elif kind == 2:
            attribute.f = self.choice.choice((0.0, -1.0, 1e30, float("inf"), float("nan")))
        elif attribute.type == onnx.AttributeProto.INTS:
            self.changed(attribute.ints)
        else:
            attribute.i = self.number()

    def node(self):
        node = self.any_of(self.graph.node)
        kind = self.choice.randrange(5)
        if kind == 0:
            self.graph.node.remove(node)
        elif kind == 1:
            self.graph.node.add().CopyFrom(node)
        elif kind == 2:
            del node.attribute[self.choice.randrange(len(node.attribute))]
        else:
            node.op_type = self.choice.choice(OPERATOR_NAMES)

    def inputs(self):
        node = self.any_of(self.graph.node)
        names = self.choice.choice((node.input, node.output))
        kind = self.choice.randrange(3)
        if kind == 0:
            names.append(self.choice.choice(self.names()))
        elif kind == 1:
            del names[self.choice.randrange(len(names))]
        else:
            names[self.choice.randrange(len(names))] = self.choice.choice(self.names())

    def weights(self):
        weights = self.any_of(self.graph.initializer)
        kind = self.choice.randrange(4)
        if kind == 0:
            self.changed(weights.dims)
        elif kind == 1:
            weights.data_type = self.choice.choice(TYPES)
        elif kind == 2:
            weights.raw_data = weights.raw_data[:self.choice.randrange(len(weights.raw_data) + 1)]
        else:  # other numbers of the same size
            numbers = np.frombuffer(weights.raw_data, np.uint8).copy()
            numbers[self.choice.randrange(len(numbers))] = self.choice.choice((0, 0x7F, 0x80, 0xFF))
            weights.raw_data = numbers.tobytes()

    def opset(self):
        self.any_of(self.opsets).version = self.choice.randrange(9, 21)


def mutate(data, max_size, seed):
    choice = random.Random(seed)
    model = onnx.ModelProto()
    try:
        model.ParseFromString(data)
    except Exception:  # not a model; the exception depends on the version of protobuf
        return atheris.Mutate(data, max_size)
    if choice.random() < 0.1:
        return atheris.Mutate(data, max_size)
    edits = Edits(model, choice)
    for _ in range(choice.randrange(1, 4)):
        edits.one()
    mutated = model.SerializeToString()
    return mutated if len(mutated) <= max_size else data


def convert(data):
    """Any exception but SystemExit with a line of text breaks the target."""
    let_go_of_comparisons()
    with tempfile.TemporaryDirectory(dir=WORK) as folder:
        model, output = Path(folder, "model.onnx"), Path(folder, "model.mien")
        model.write_bytes(data)
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                onnx_to_mien.main([str(model), "-o", str(output)])
        except SystemExit as stop:
            if not isinstance(stop.code, str) or "\n" in stop.code or output.exists():
                raise RuntimeError(
                    f"refused with {stop.code!r}, output {'there' if output.exists() else 'not there'}") from stop


@functools.cache
def let_go_of_comparisons():
    """atheris 3.0.0 keeps the results of comparisons; arrays of these take gigabytes within minutes. The target calls
    this, because atheris.Fuzz() installs its own function first."""
    traced = atheris._trace_cmp
    operators = (operator.lt, operator.le, operator.eq, operator.ne, operator.gt, operator.ge)  # as in dis.cmp_op

    def compared(left, right, kind, *where):
        if isinstance(left, np.ndarray) or isinstance(right, np.ndarray):
            return operators[kind](left, right)
        return traced(left, right, kind, *where)

    atheris._trace_cmp = compared  # instrumented code looks it up at every comparison


def write_seeds(folder):
    import operator_cases
    import refused_cases
    for case in (*operator_cases.accepted(), *refused_cases.refused()):
        Path(folder, f"{case.name}.onnx").write_bytes(case.model().SerializeToString())


if sys.argv[1:2] == ["--seeds"]:
    write_seeds(sys.argv[2])
else:
    WORK = "/dev/shm" if Path("/dev/shm").is_dir() else None
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    atheris.Setup(sys.argv, convert, custom_mutator=mutate)
    atheris.Fuzz()
