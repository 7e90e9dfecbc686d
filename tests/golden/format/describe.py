#!/usr/bin/env python3
"""Writes the .mien file of a JSON description with the Python writer. tests/formats/description.cpp does the same with
the C++ writer.

usage: describe.py DESCRIPTION.json FILE.mien
"""
import json
import sys
from array import array
from math import prod
from pathlib import Path

from mien_convert.weight_file import MienFile


class Numbers:
    """Multiples of 2^-22 in -2..2 from a linear congruential generator (Numerical Recipes), the same on every machine."""

    def __init__(self, seed):
        self.state = seed

    def array(self, shape):
        values = array("f")
        for _ in range(prod(shape)):
            self.state = (self.state * 1664525 + 1013904223) % 2**32
            values.append(((self.state >> 8) - 2**23) / 2**22)
        return values, tuple(shape)


def add_layer(net, layer, numbers):
    op, x, options = layer["op"], layer["x"], dict(layer.get("options", {}))
    arrays = [numbers.array(shape) for shape in layer.get("weights", [])]
    if layer.get("bias"):
        arrays.append(numbers.array([layer["bias"]]))
    if layer.get("slopes"):
        options["slopes"] = numbers.array([layer["slopes"]])
    if op == "max_pool":
        return net.max_pool(x, layer["kernel"], **options)
    if op == "add":
        return net.add(x, layer["b"], **options)
    if op == "concat":
        return net.concat(x, layer["b"], **options)
    if op == "slice":
        return net.slice(x, layer["first_channel"], layer["channels"], **options)
    if op in ("multiply", "divide", "broadcast_add"):
        return getattr(net, op)(x, layer["b"], **options)
    if op == "resize":
        return net.resize(x, *layer["size"], layer["grid"], layer["sampling"], **options)
    if op == "rearrange":
        return net.rearrange(x, layer["order"], layer["shape"], **options)
    if op == "normalize":
        return net.normalize(x, options.pop("alpha"), **options)
    if op == "activation":
        return net.activation(x, options.pop("activation"), **options)
    return getattr(net, op)(x, *arrays, **options)


def described(description):
    numbers, file = Numbers(description["seed"]), MienFile()
    for network in description["networks"]:
        net = file.network(network["name"], network["input"], any_size=network.get("any_size", False))
        for layer in network["layers"]:
            add_layer(net, layer, numbers)
        for value in network["outputs"]:
            net.output(value)
    for constant in description.get("constants", []):
        file.constant(constant["name"], numbers.array(constant["shape"]), constant["type"])
    file.metadata.update(description.get("metadata", {}))
    return file


if __name__ == "__main__":
    described(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))).write(sys.argv[2])
