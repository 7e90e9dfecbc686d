"""Random ONNX graphs: chains of convolutions of every kind, blocks, pools, sums and joins, with one to three
outputs.

They use only what docs/convert.md supports: each must be converted, with the outputs of ONNX Runtime.
"""
import numpy as np
from operator_cases import Case, node, weights

ACTIVATIONS = [("Relu", {}), ("LeakyRelu", {"alpha": 0.125}), ("Sigmoid", {}), ("Tanh", {}), None, None]


class Graph:
    """Grows from an input; maps are names with [channels, rows, columns]."""

    def __init__(self, seed):
        self.random = np.random.default_rng(seed)
        self.nodes, self.constants, self.folds = [], {}, 0
        self.shape = (self.pick(1, 24), self.pick(4, 26), self.pick(4, 26))
        self.maps = {"x": self.shape}
        self.last = "x"

    def pick(self, low, high):
        return int(self.random.integers(low, high + 1))

    def add(self, operator, inputs, shape, constants=(), **attributes):
        """A node whose result is the last map; constants are its further inputs."""
        at = len(self.nodes)
        names = [f"c{at}_{i}" for i in range(len(constants))]
        self.constants.update(zip(names, constants))
        self.nodes.append(node(operator, " ".join([*inputs, *names]), f"m{at}", **attributes))
        self.last = f"m{at}"
        self.maps[self.last] = shape

    def activation(self):
        chosen = ACTIVATIONS[self.pick(0, len(ACTIVATIONS) - 1)]
        if chosen:
            self.add(chosen[0], [self.last], self.maps[self.last], **chosen[1])

    def relu6(self):
        self.add("Clip", [self.last], self.maps[self.last], [np.float32(0), np.float32(6)])

    def convolve(self, channels, kernel, stride, depthwise=False):
        c, h, w = self.maps[self.last]
        kh, kw = min(kernel, h), min(kernel, w)
        pads = [self.pick(0, kh - 1), self.pick(0, kw - 1), self.pick(0, kh - 1), self.pick(0, kw - 1)]
        rows, columns = ((n + before + after - k) // stride + 1
                         for n, k, before, after in ((h, kh, pads[0], pads[2]), (w, kw, pads[1], pads[3])))
        inputs = [weights(channels, 1 if depthwise else c, kh, kw)] + [weights(channels)] * self.pick(0, 1)
        self.add("Conv", [self.last], (channels, rows, columns), inputs, kernel_shape=[kh, kw],
                 strides=[stride, stride], pads=pads, group=c if depthwise else 1)

    def conv(self):
        self.convolve(self.pick(1, 24), (1, 1, 2, 3, 3, 5)[self.pick(0, 5)], self.pick(1, 2))
        self.norm()
        self.activation()

    def depthwise(self):
        self.convolve(self.maps[self.last][0], (2, 3, 3, 5)[self.pick(0, 3)], self.pick(1, 2), depthwise=True)
        self.activation()

    def norm(self):
        if self.pick(0, 3) == 0:
            c = self.maps[self.last][0]
            positive = [self.random.uniform(0.5, 2, c).astype(np.float32) for _ in range(2)]
            self.add("BatchNormalization", [self.last],
                     self.maps[self.last], [positive[0], weights(c), weights(c), positive[1]])
            self.folds += 1

    def block(self):
        """An inverted residual, which the engine runs in one step where it can."""
        start, (c, h, w) = self.last, self.maps[self.last]
        wide, stride = c * self.pick(1, 4), self.pick(1, 2)
        self.add("Conv", [self.last], (wide, h, w), [weights(wide, c, 1, 1), weights(wide)])
        self.relu6()
        self.add("Conv", [self.last], (wide, -(-h // stride), -(-w // stride)), [weights(wide, 1, 3, 3), weights(wide)],
                 group=wide, strides=[stride, stride], pads=[1, 1, 1, 1])
        self.relu6()
        out = c if self.pick(0, 1) else self.pick(1, 24)
        self.add("Conv", [self.last], (out, *self.maps[self.last][1:]), [weights(out, wide, 1, 1), weights(out)])
        if self.maps[self.last] == self.maps[start]:
            self.add("Add", [self.last, start], self.maps[start])

    def pool(self):
        c, h, w = self.maps[self.last]
        size, stride = min(self.pick(2, 3), h, w), self.pick(1, 2)
        self.add("MaxPool", [self.last], (c, (h - size) // stride + 1, (w - size) // stride + 1),
                 kernel_shape=[size, size], strides=[stride, stride])

    def join(self):
        """A sum or a concatenation with an earlier map that fits."""
        shape = self.maps[self.last]
        others = [name for name, other in self.maps.items() if other[1:] == shape[1:] and name != self.last]
        if not others:
            return
        other = others[self.pick(0, len(others) - 1)]
        if self.maps[other] == shape:
            self.add("Add", [self.last, other], shape)
        else:
            self.add("Concat", [self.last, other], (shape[0] + self.maps[other][0], *shape[1:]), axis=1)

    def head(self):
        c = self.maps[self.last][0]
        self.add("GlobalAveragePool", [self.last], (c, 1, 1))
        self.add("Flatten", [self.last], (c, 1, 1))
        wanted = self.pick(1, 20)
        self.add("Gemm", [self.last], (wanted, 1, 1), [weights(c, wanted), weights(wanted)])
        if self.pick(0, 1):
            self.add("Softmax", [self.last], (wanted, 1, 1), axis=1)

    def grow(self):
        steps = [self.conv, self.conv, self.depthwise, self.block, self.block, self.pool, self.join, self.activation]
        for _ in range(self.pick(2, 9)):
            steps[self.pick(0, len(steps) - 1)]()
        if not self.nodes:
            self.conv()
        outputs = [self.last]
        if self.pick(0, 2) == 0:
            self.head()
            outputs.append(self.last)
        return outputs


def graphs(count, seed=1):
    for i in range(count):
        graph = Graph((seed, i))
        outputs = graph.grow()
        yield Case(f"random_{i}", graph.nodes, {"x": [1, *graph.shape]}, outputs, constants=graph.constants,
                   rounds=graph.folds)
