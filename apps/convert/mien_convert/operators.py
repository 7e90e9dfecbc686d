"""One function for each ONNX operator: (translator, node) -> its outputs. docs/convert.md lists them.

node.inputs are Tensors, numpy arrays (constants) or None. Operators whose inputs are all constants are evaluated in
advance (constants.py), except those of MOVES, which also accept constants.
"""
from .activations import (
         CURVES,
         clip,
         elu,
         gelu,
         hard_sigmoid,
         largest,
         leaky_relu,
         prelu,
         relu,
         sigmoid,
         smallest,
         softmax,
         swish,
         tanh,
)
from .arithmetic import absolute, add, batch_norm, divide, layer_norm, multiply, negate, power, reciprocal, subtract
from .convolution import (
         average_pool,
         conv,
         fused_conv,
         global_average_pool,
         global_max_pool,
         max_pool,
         reduce_mean,
         reduce_sum,
)
from .data_movement import (
         cast,
         concat,
         dropout,
         flatten,
         gather,
         identity,
         pad,
         reshape,
         shape,
         slice_,
         split,
         squeeze,
         transpose,
         unsqueeze,
)
from .matrix import gemm, matmul
from .resize import resize, upsample
from .stateful import lstm

MOVES = {"Identity": identity, "Dropout": dropout, "Reshape": reshape, "Flatten": flatten, "Squeeze": squeeze,
         "Unsqueeze": unsqueeze,
         "Transpose": transpose, "Gather": gather, "Slice": slice_, "Split": split, "Concat": concat, "Shape": shape}
OPERATORS = {
    **MOVES, "Cast": cast, "Pad": pad, "Add": add, "Sum": add, "Sub": subtract, "Mul": multiply, "Div": divide,
    "Neg": negate,
    "BatchNormalization": batch_norm, "Relu": relu, "LeakyRelu": leaky_relu, "PRelu": prelu, "Sigmoid": sigmoid,
    "Tanh": tanh, "Clip": clip,
    "HardSigmoid": hard_sigmoid, "Softmax": softmax, "Conv": conv, "MaxPool": max_pool, "AveragePool": average_pool,
    "GlobalAveragePool": global_average_pool, "GlobalMaxPool": global_max_pool, "ReduceMean": reduce_mean, "Gemm": gemm,
    "MatMul": matmul,
    "LSTM": lstm, **CURVES, "Gelu": gelu, "Swish": swish, "Elu": elu, "Max": largest, "Min": smallest, "Pow": power,
    "Abs": absolute,
    "Reciprocal": reciprocal, "LayerNormalization": layer_norm, "ReduceSum": reduce_sum, "Resize": resize,
    "Upsample": upsample, "FusedConv": fused_conv,
}
