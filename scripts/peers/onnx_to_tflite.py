#!/usr/bin/env python3
"""Writes an encoder's ONNX file as a LiteRT one: convolutions, clamps to 0..6, additions, crops.

usage: onnx_to_tflite.py IN.onnx OUT.tflite

No converter that PyPI has reads ONNX without TensorFlow, and these are seven operators. Maps become channels-last;
clamps become a part of the convolution, crops one operator, padding that LiteRT cannot name (symmetric, at a stride) an
operator before the convolution.
"""
import sys

import flatbuffers
import numpy as np
import onnx
from ai_edge_litert import schema_py_generated as schema
from onnx import numpy_helper

OPERATOR, OPTIONS, ACTIVATION = schema.BuiltinOperator, schema.BuiltinOptions, schema.ActivationFunctionType
TYPES = {np.dtype(np.float32): schema.TensorType.FLOAT32, np.dtype(np.int32): schema.TensorType.INT32}
VERSION = 3  # of the format


class Writer:
    def __init__(self):
        self.model = schema.ModelT(version=VERSION, operatorCodes=[], buffers=[schema.BufferT()])
        self.graph = schema.SubGraphT(tensors=[], operators=[], inputs=[], outputs=[])
        self.codes = {}

    def tensor(self, shape, kind=np.float32, data=None):
        buffer = 0
        if data is not None:
            buffer = len(self.model.buffers)
            self.model.buffers.append(schema.BufferT(data=np.frombuffer(data.tobytes(), np.uint8)))
        index = len(self.graph.tensors)
        self.graph.tensors.append(schema.TensorT(shape=list(shape), type=TYPES[np.dtype(kind)], buffer=buffer,
                                                 name=f"t{index}"))
        return index

    def constant(self, values, kind):
        values = np.ascontiguousarray(values, kind)
        return self.tensor(values.shape, kind, values)

    def shape(self, index):
        return self.graph.tensors[index].shape

    def operator(self, code, inputs, shape, options=None, options_type=0):
        if code not in self.codes:
            self.codes[code] = len(self.codes)
            self.model.operatorCodes.append(schema.OperatorCodeT(builtinCode=code, deprecatedBuiltinCode=code))
        out = self.tensor(shape)
        self.graph.operators.append(schema.OperatorT(opcodeIndex=self.codes[code], inputs=inputs, outputs=[out],
                                                     builtinOptions=options, builtinOptionsType=options_type))
        return out

    def convolution(self, x, weights, bias, strides, pads, groups):
        weights = weights.transpose(0, 2, 3, 1)  # outputs, height, width, inputs
        size, sliding = weights.shape[1:3], groups > 1
        same = pads == [1, 1, 1, 1] and list(size) == [3, 3] and strides == [1, 1]
        if any(pads) and not same:
            x = self.pad(x, pads)
            pads = [0, 0, 0, 0]
        n, h, w, _ = self.shape(x)
        shape = (n, *((a + before + after - k) // s + 1
                      for a, before, after, k, s in zip((h, w), pads[:2], pads[2:], size, strides)), len(weights))
        weights = weights.transpose(3, 1, 2, 0) if sliding else weights
        options = (schema.DepthwiseConv2DOptionsT(depthMultiplier=1) if sliding else schema.Conv2DOptionsT())
        options.padding = schema.Padding.SAME if same else schema.Padding.VALID
        options.strideH, options.strideW = strides
        kind = (OPERATOR.DEPTHWISE_CONV_2D, OPTIONS.DepthwiseConv2DOptions) if sliding else (OPERATOR.CONV_2D,
                                                                                             OPTIONS.Conv2DOptions)
        return self.operator(kind[0], [x, self.constant(weights, np.float32), self.constant(bias, np.float32)], shape,
                             options, kind[1])

    def pad(self, x, pads):
        amounts = np.array([[0, 0], [pads[0], pads[2]], [pads[1], pads[3]], [0, 0]])
        shape = np.array(self.shape(x)) + amounts.sum(1)
        return self.operator(OPERATOR.PAD, [x, self.constant(amounts, np.int32)], shape.tolist(), schema.PadOptionsT(),
                             OPTIONS.PadOptions)

    def crop(self, x, axis, start, end):
        begin, shape = [0, 0, 0, 0], list(self.shape(x))
        begin[axis], shape[axis] = start, (end + shape[axis] if end < 0 else min(end, shape[axis])) - start
        return self.operator(OPERATOR.SLICE, [x, self.constant(begin, np.int32), self.constant(shape, np.int32)], shape,
                             schema.SliceOptionsT(), OPTIONS.SliceOptions)

    def add(self, a, b):
        return self.operator(OPERATOR.ADD, [a, b], self.shape(a), schema.AddOptionsT(), OPTIONS.AddOptions)

    def clamp_to_six(self, x):
        """Fuses the clamp into the convolution that computes x."""
        convolution = self.graph.operators[-1]
        assert list(convolution.outputs) == [x]
        convolution.builtinOptions.fusedActivationFunction = ACTIVATION.RELU6
        return x

    def bytes(self):
        named = lambda name, tensors: [schema.TensorMapT(name=name, tensorIndex=tensors[0])]
        self.model.subgraphs = [self.graph]
        self.model.signatureDefs = [schema.SignatureDefT(signatureKey="serving_default", subgraphIndex=0,
                                                         inputs=named("image", self.graph.inputs),
                                                         outputs=named("embedding", self.graph.outputs))]
        builder = flatbuffers.Builder(1 << 24)
        builder.Finish(self.model.Pack(builder), file_identifier=b"TFL3")
        return bytes(builder.Output())


def convert(model):
    writer, graph = Writer(), model.graph
    constants = {t.name: numpy_helper.to_array(t) for t in graph.initializer}
    (image,) = [i for i in graph.input if i.name not in constants]
    n, c, h, w = (d.dim_value for d in image.type.tensor_type.shape.dim)
    maps = {image.name: writer.tensor((n, h, w, c))}
    writer.graph.inputs = [maps[image.name]]
    for node in graph.node:
        attributes = {a.name: onnx.helper.get_attribute_value(a) for a in node.attribute}
        inputs = [constants.get(i, maps.get(i)) for i in node.input]
        if node.op_type == "Constant":
            constants[node.output[0]] = numpy_helper.to_array(attributes["value"])
        elif node.op_type == "Identity" and node.input[0] in constants:
            constants[node.output[0]] = inputs[0]
        else:
            maps[node.output[0]] = operator(writer, node.op_type, inputs, attributes)
    writer.graph.outputs = [maps[graph.output[0].name]]
    return writer.bytes()


def operator(writer, kind, inputs, attributes):
    if kind == "Conv":
        return writer.convolution(*inputs, attributes["strides"], attributes["pads"], attributes["group"])
    if kind == "Clip" and [float(v) for v in inputs[1:]] == [0, 6]:
        return writer.clamp_to_six(inputs[0])
    if kind == "Add":
        return writer.add(*inputs)
    if kind == "Slice":
        start, end, axis, step = (int(np.ravel(v)[0]) for v in inputs[1:])
        assert step == 1
        return writer.crop(inputs[0], (0, 3, 1, 2)[axis], start, end)
    if kind == "Flatten":  # of a map of one pixel
        return inputs[0]
    sys.exit(f"onnx_to_tflite.py: {kind} {attributes}: unsupported operator")


def main():
    with open(sys.argv[2], "wb") as out:
        out.write(convert(onnx.load(sys.argv[1])))


if __name__ == "__main__":
    main()
