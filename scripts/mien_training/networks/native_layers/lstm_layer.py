"""nn.LSTM with one layer, for training on CPUs, without waits between small matrix products."""
import ctypes
import functools
from ctypes import c_size_t, c_void_p
from pathlib import Path

import torch
from torch import nn

from mien_training.native_build import library

MULTIPLE = 32  # of the hidden size


@functools.lru_cache
def native():
    lib = ctypes.CDLL(str(library(Path(__file__).resolve().parent / "lstm_layer.cpp")))
    for function in (lib.lstm_forward, lib.lstm_backward):
        function.argtypes = [c_void_p, c_void_p, c_size_t, c_size_t, c_size_t,
                             *[c_void_p] * (2 if function is lib.lstm_forward else 3)]
        function.restype = None
    return lib


class Fused(torch.autograd.Function):
    """x [steps,batch,in] -> h [steps,batch,hidden] and the last c [batch,hidden], from a state of zeros."""

    @staticmethod
    def forward(ctx, x, weight_ih, weight_hh, bias):
        steps, batch, _ = x.shape
        hidden = weight_hh.shape[1]
        gates = torch.addmm(bias, x.flatten(0, 1), weight_ih.t())
        h, c = (x.new_zeros(steps + 1, batch, hidden) for _ in range(2))
        turned = weight_hh.t().contiguous()
        native().lstm_forward(gates.data_ptr(), turned.data_ptr(), steps, batch, hidden, h.data_ptr(), c.data_ptr())
        ctx.save_for_backward(x, weight_ih, weight_hh, gates, h, c)
        last = c[-1].clone()
        ctx.mark_non_differentiable(last)
        return h[1:], last

    @staticmethod
    def backward(ctx, dy, _):
        x, weight_ih, weight_hh, gates, h, c = ctx.saved_tensors
        steps, batch, hidden = dy.shape
        dh = dy.contiguous().clone()
        dc = dy.new_zeros(batch, hidden)
        slopes = gates.clone()
        weight = weight_hh.contiguous()
        native().lstm_backward(slopes.data_ptr(), weight.data_ptr(), steps, batch, hidden, c.data_ptr(), dh.data_ptr(),
                               dc.data_ptr())
        return ((slopes @ weight_ih).view_as(x), slopes.t() @ x.flatten(0, 1), slopes.t() @ h[:-1].flatten(0, 1),
                slopes.sum(0))


class Lstm(nn.LSTM):
    """Batch first, one layer. In training on a CPU sequences from a state of zeros take the short way; no gradient
    flows through the state they leave."""

    def __init__(self, inputs, hidden):
        super().__init__(inputs, hidden, batch_first=True)

    def forward(self, x, state=None):
        on_cpu = x.device.type == "cpu" and x.dtype == torch.float32
        if state is not None or not self.training or not on_cpu or self.hidden_size % MULTIPLE:
            return super().forward(x, state)
        h, c = Fused.apply(x.transpose(0, 1).contiguous(), self.weight_ih_l0, self.weight_hh_l0,
                           self.bias_ih_l0 + self.bias_hh_l0)
        return h.transpose(0, 1), (h[-1:].detach(), c[None])
