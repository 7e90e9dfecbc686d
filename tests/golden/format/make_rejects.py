#!/usr/bin/env python3
"""Writes reject/: files of accept/ with one rule broken in each and a correct checksum, and reject/expected.txt with
lines "file status offset"."""
import struct
from pathlib import Path

from mien_convert.xxhash64 import xxhash64

HERE = Path(__file__).parent

BASE = (HERE / "accept/small.mien").read_bytes()
NETWORKS, LAYERS, TENSORS, METADATA, STRINGS, DATA = 64, 192, 448, 1024, 1056, 1088
CONV, FC, ADD, CAUSAL = (LAYERS + 64 * i for i in range(4))
CONSTANT = TENSORS + 64 * 7  # "c", 3 x fp32
CONSTANT_DATA = len(BASE) - 128
NAN = float("nan")
PARTS = (HERE / "accept/parts.mien").read_bytes()
EVERY_OP = (HERE / "accept/every_op.mien").read_bytes()
SLICE, _, CONCAT, MEAN = (128 + 64 * i for i in range(4))

# name, status, offset that the reader reports (None: where the first change is), changes (format, offset, value)
CASES = [
    ("magic", "kBadMagic", 4, [("B", 4, 0x4F)]),
    ("big_endian", "kWrongEndian", 12, [("I", 12, 0x04030201)]),
    ("major_version", "kUnsupportedVersion", 8, [("H", 8, 2)]),
    ("minor_version", "kUnsupportedVersion", 8, [("H", 10, 4)]),
    ("version_not_needed", "kUnsupportedVersion", 10, [("H", 10, 1)]),
    ("header_bytes", "kUnsupportedVersion", 16, [("I", 16, 128)]),
    ("no_network", "kLimitExceeded", 20, [("I", 20, 0)]),
    ("networks", "kLimitExceeded", 20, [("I", 20, 65)]),
    ("layers", "kLimitExceeded", 24, [("I", 24, 1025)]),
    ("tensors", "kLimitExceeded", 28, [("I", 28, 4097)]),
    ("metadata", "kLimitExceeded", 32, [("I", 32, 257)]),
    ("total_bytes_limit", "kLimitExceeded", 40, [("Q", 40, 2**31 + 1)]),
    ("total_bytes_more", "kTruncated", len(BASE), [("Q", 40, len(BASE) + 64)]),
    ("total_bytes_less", "kTrailingBytes", len(BASE) - 64, [("Q", 40, len(BASE) - 64)]),
    ("records_beyond_end", "kTruncated", len(BASE), [("I", 28, 4096)]),
    ("strings_beyond_end", "kTruncated", len(BASE), [("I", 36, 2**32 - 1)]),
    ("data_offset", "kHole", 48, [("Q", 48, DATA + 64)]),
    ("string_bytes", "kHole", 36, [("I", 36, 22)]),
    ("padding_of_strings", "kPaddingNotZero", STRINGS + 21, [("B", DATA - 1, 1)]),
    ("string_hole", "kHole", None, [("I", NETWORKS, 1)]),
    ("string_overlap", "kHole", None, [("I", NETWORKS + 64, 0)]),
    ("string_too_long", "kHole", METADATA + 24, [("I", METADATA + 28, 2**32 - 1)]),
    ("anonymous_string_offset", "kHole", None, [("I", TENSORS, 0)]),
    ("name_empty", "kBadName", NETWORKS, [("I", NETWORKS + 4, 0), ("I", NETWORKS + 64, 0), ("I", NETWORKS + 68, 2)]),
    ("name_upper_case", "kBadName", NETWORKS, [("B", STRINGS, ord("A"))]),
    ("key_space", "kBadName", METADATA, [("B", STRINGS + 4, ord(" "))]),
    ("name_nul", "kBadName", CONSTANT, [("B", STRINGS + 2, 0)]),
    ("duplicate_network", "kDuplicateName", NETWORKS + 64, [("B", STRINGS + 1, ord("a"))]),
    ("duplicate_constant", "kDuplicateName", CONSTANT + 64, [("B", STRINGS + 3, ord("c"))]),
    ("duplicate_key", "kDuplicateName", METADATA + 16,
     [("I", METADATA + 12, 10), ("I", METADATA + 16, 17), ("I", METADATA + 20, 3), ("I", METADATA + 24, 20), ("I", METADATA + 28, 1),
      ("10s", STRINGS + 7, b"0123456789"), ("3s", STRINGS + 17, b"key")]),
    ("text_control", "kBadMetadata", METADATA + 8, [("B", STRINGS + 7, 0)]),
    ("text_delete", "kBadMetadata", METADATA + 8, [("B", STRINGS + 7, 0x7F)]),
    ("text_overlong", "kBadMetadata", METADATA + 8, [("2s", STRINGS + 7, b"\xc0\x80")]),
    ("text_surrogate", "kBadMetadata", METADATA + 8, [("3s", STRINGS + 7, b"\xed\xa0\x80")]),
    ("text_first_of_c1", "kBadMetadata", METADATA + 8, [("2s", STRINGS + 7, b"\xc2\x80")]),
    ("text_last_of_c1", "kBadMetadata", METADATA + 8, [("2s", STRINGS + 7, b"\xc2\x9f")]),
    ("text_cut_character", "kBadMetadata", METADATA + 24, [("B", STRINGS + 20, 0xC3)]),
    ("text_beyond_unicode", "kBadMetadata", METADATA + 8, [("4s", STRINGS + 7, b"\xf4\x90\x80\x80")]),
    ("input_zero", "kBadNetwork", None, [("I", NETWORKS + 8, 0)]),
    ("input_limit", "kBadNetwork", NETWORKS + 8, [("I", NETWORKS + 12, 2**20 + 1)]),
    ("input_elements", "kBadNetwork", NETWORKS + 8, [("I", NETWORKS + 8, 2**20), ("I", NETWORKS + 12, 2**20)]),
    ("network_flags", "kBadNetwork", None, [("I", NETWORKS + 20, 2)]),
    ("first_layer", "kBadNetwork", None, [("I", NETWORKS + 64 + 24, 2)]),
    ("no_layers", "kBadNetwork", NETWORKS + 64 + 24, [("I", NETWORKS + 64 + 28, 0)]),
    ("layers_beyond_file", "kBadNetwork", NETWORKS + 64 + 24, [("I", NETWORKS + 64 + 28, 2)]),
    ("layers_left_over", "kBadNetwork", 24,
     [("I", NETWORKS + 28, 2), ("I", NETWORKS + 36, 2), ("I", NETWORKS + 64 + 24, 2), ("64s", ADD, BASE[CAUSAL:CAUSAL + 64])]),
    ("no_output", "kBadNetwork", None, [("I", NETWORKS + 32, 0)]),
    ("outputs", "kBadNetwork", None, [("I", NETWORKS + 32, 5)]),
    ("output_is_input", "kBadNetwork", None, [("I", NETWORKS + 36, 0)]),
    ("output_beyond", "kBadNetwork", None, [("I", NETWORKS + 36, 4)]),
    ("output_unused", "kBadNetwork", None, [("I", NETWORKS + 40, 1)]),
    ("network_reserved", "kReservedNotZero", NETWORKS + 52, [("I", NETWORKS + 60, 1)]),
    ("op_zero", "kBadOp", CONV, [("H", CONV, 0)]),
    ("op_unknown", "kBadOp", CONV, [("H", 10, 2), ("H", CONV, 20)]),
    ("op_of_a_later_version", "kBadOp", CONV, [("H", CONV, 11)]),
    ("any_size_fully_connected", "kBadOp", FC, [("I", NETWORKS + 20, 1)]),
    ("activation_unknown", "kBadActivation", CONV, [("H", CONV + 2, 8)]),
    ("activation_of_add", "kBadActivation", ADD, [("H", ADD + 2, 1)]),
    ("activation_missing", "kBadActivation", ADD, [("H", ADD, 9), ("I", ADD + 8, 2**32 - 1)]),
    ("alpha_zero", "kBadActivation", CONV, [("f", CONV + 44, 0.0)]),
    ("alpha_one", "kBadActivation", CONV, [("f", CONV + 44, 1.0)]),
    ("alpha_nan", "kBadActivation", CONV, [("f", CONV + 44, NAN)]),
    ("alpha_unused", "kBadActivation", FC, [("f", FC + 44, 0.5)]),
    ("alpha_denormal", "kBadActivation", FC, [("I", FC + 44, 1)]),
    ("alpha_minus_zero", "kBadActivation", FC, [("f", FC + 44, -0.0)]),
    ("input_is_itself", "kBadReference", FC, [("I", FC + 4, 2)]),
    ("input_beyond", "kBadReference", ADD, [("I", ADD + 4, 2**32 - 1)]),
    ("second_input_missing", "kBadReference", ADD, [("I", ADD + 8, 2**32 - 1)]),
    ("second_input_unused", "kBadReference", FC, [("I", FC + 8, 0)]),
    ("kernel_zero", "kBadKernel", CONV, [("H", CONV + 24, 0)]),
    ("kernel_limit", "kBadKernel", CONV, [("H", CONV + 26, 16)]),
    ("stride_zero", "kBadKernel", CONV, [("H", CONV + 28, 0)]),
    ("stride_limit", "kBadKernel", CONV, [("H", CONV + 30, 16)]),
    ("padding_limit", "kBadKernel", CONV, [("H", CONV + 32, 3)]),
    ("kernel_unused", "kBadKernel", FC, [("H", FC + 24, 1)]),
    ("padding_unused", "kBadKernel", FC, [("H", FC + 38, 1)]),
    ("layer_flags", "kBadKernel", CONV, [("H", CONV + 40, 1)]),
    ("layer_reserved", "kReservedNotZero", CONV, [("H", CONV + 42, 1)]),
    ("layer_reserved_tail", "kReservedNotZero", CONV, [("I", CONV + 60, 1)]),
    ("output_height", "kBadShape", None, [("I", CONV + 12, 2)]),
    ("output_channels", "kBadShape", ADD + 12, [("I", ADD + 20, 3)]),
    ("kernel_larger_than_map", "kBadShape", CONV + 12, [("H", CONV + 24, 4)]),
    ("add_of_other_channels", "kBadShape", ADD + 12, [("I", ADD + 8, 1)]),
    ("lstm_of_three", "kBadShape", CAUSAL + 12, [("H", CAUSAL, 6)]),
    ("causal_conv_of_map", "kBadShape", CAUSAL + 12, [("I", NETWORKS + 64 + 8, 3)]),
    ("weights_missing", "kBadTensor", None, [("I", CONV + 48, 2**32 - 1)]),
    ("weights_of_another", "kBadTensor", None, [("I", FC + 48, 0)]),
    ("weights_of_add", "kBadTensor", None, [("I", ADD + 48, 5)]),
    ("slopes_unused", "kBadTensor", None, [("I", CONV + 56, 2)]),
    ("weights_dims", "kBadTensor", CONV + 48, [("I", TENSORS + 20, 9), ("I", TENSORS + 24, 1)]),
    ("bias_rank", "kBadTensor", CONV + 52, [("H", TENSORS + 64 + 10, 2), ("I", TENSORS + 64 + 20, 1)]),
    ("bias_fp32", "kBadTensor", CONV + 52, [("H", TENSORS + 64 + 8, 2), ("Q", TENSORS + 64 + 40, 32)]),
    ("layer_tensor_with_name", "kBadTensor", CAUSAL + 52,
     [("I", TENSORS + 64 * 6 + 4, 1), ("I", CONSTANT, 3), ("I", CONSTANT + 4, 1), ("I", CONSTANT + 64, 4), ("I", CONSTANT + 68, 1),
      ("I", METADATA, 5), ("I", METADATA + 4, 2)]),
    ("tensor_of_nobody", "kUnusedTensor", CONSTANT, [("I", CONSTANT + 4, 0), ("I", CONSTANT + 64, 2), ("I", CONSTANT + 68, 2)]),
    ("type_zero", "kBadType", None, [("H", CONSTANT + 8, 0)]),
    ("type_unknown", "kBadType", None, [("H", CONSTANT + 8, 3)]),
    ("rank_zero", "kBadDims", None, [("H", CONSTANT + 10, 0)]),
    ("rank_limit", "kBadDims", None, [("H", CONSTANT + 10, 5)]),
    ("dim_zero", "kBadDims", None, [("I", CONSTANT + 16, 0)]),
    ("dim_limit", "kBadDims", None, [("I", CONSTANT + 16, 2**20 + 1)]),
    ("dim_unused", "kBadDims", None, [("I", CONSTANT + 20, 1)]),
    ("dims_overflow", "kBadTensorBytes", CONSTANT + 40, [("H", CONSTANT + 10, 4), ("4I", CONSTANT + 16, (2**20,) * 4), ("Q", CONSTANT + 40, 0)]),
    ("tensor_bytes", "kBadTensorBytes", None, [("Q", CONSTANT + 40, 6)]),
    ("tensor_hole", "kHole", None, [("Q", CONSTANT + 32, len(BASE) - 64)]),
    ("tensor_overlap", "kHole", None, [("Q", CONSTANT + 32, DATA)]),
    ("tensor_offset_wraps", "kHole", None, [("Q", CONSTANT + 32, 2**64 - 64)]),
    ("tensor_beyond_end", "kTruncated", len(BASE), [("I", CONSTANT + 64 + 16, 64), ("Q", CONSTANT + 64 + 40, 128)]),
    ("tensor_reserved", "kReservedNotZero", None, [("I", CONSTANT + 12, 1)]),
    ("tensor_reserved_tail", "kReservedNotZero", CONSTANT + 48, [("I", CONSTANT + 60, 1)]),
    ("tensor_padding", "kPaddingNotZero", CONSTANT_DATA + 12, [("B", CONSTANT_DATA + 63, 1)]),
    ("infinity_fp32", "kNonFinite", CONSTANT_DATA, [("f", CONSTANT_DATA + 8, float("-inf"))]),
    ("nan_fp32", "kNonFinite", CONSTANT_DATA, [("f", CONSTANT_DATA, NAN)]),
    ("infinity_fp16", "kNonFinite", DATA, [("H", DATA + 2, 0x7C00)]),
    ("nan_fp16", "kNonFinite", DATA, [("H", DATA, 0xFE01)]),
]


# the same, of parts.mien
PARTS_CASES = [
    ("parts_in_version_0", "kBadOp", SLICE, [("H", 10, 0)]),
    ("slice_window", "kBadKernel", SLICE, [("H", SLICE + 24, 1)]),
    ("slice_activation", "kBadActivation", SLICE, [("H", SLICE + 2, 1)]),
    ("slice_second_input", "kBadReference", SLICE, [("I", SLICE + 8, 0)]),
    ("slice_beyond_channels", "kBadShape", SLICE + 12, [("H", SLICE + 42, 6)]),
    ("slice_of_nothing", "kBadShape", SLICE + 12, [("H", SLICE + 32, 6)]),
    ("slice_margins_wrap", "kBadShape", SLICE + 12, [("H", SLICE + 32, 65535), ("H", SLICE + 36, 65535)]),
    ("slice_other_height", "kBadShape", SLICE + 12, [("I", SLICE + 12, 6)]),
    ("slice_weights", "kBadTensor", SLICE + 48, [("I", SLICE + 48, 0)]),
    ("concat_missing_input", "kBadReference", CONCAT, [("I", CONCAT + 8, 2**32 - 1)]),
    ("concat_of_other_sizes", "kBadShape", CONCAT + 12, [("I", CONCAT + 8, 0)]),
    ("concat_channels", "kBadShape", CONCAT + 12, [("I", CONCAT + 20, 8)]),
    ("concat_first_channel", "kReservedNotZero", CONCAT, [("H", CONCAT + 42, 1)]),
    ("concat_padding", "kBadKernel", CONCAT, [("H", CONCAT + 32, 1)]),
    ("mean_height", "kBadShape", MEAN + 12, [("I", MEAN + 12, 5)]),
    ("mean_activation", "kBadActivation", MEAN, [("H", MEAN + 2, 1)]),
    ("mean_window", "kBadKernel", MEAN, [("H", MEAN + 28, 1)]),
]

ARITHMETIC = (HERE / "accept/arithmetic.mien").read_bytes()
BIG, SMALL = 64, 128  # its networks
OUTPUTS = BIG + 36
L = [192 + 64 * i for i in range(20)]  # its layers: 16 of the first network, 4 of the second
RESIZE, OTHER_RESIZE, MULTIPLY, ADD_BROADCAST, DIVIDE, REARRANGE, NORMALIZE, SWISH = (L[i] for i in (0, 1, 3, 5, 6, 7, 8, 10))
ARITHMETIC_CASES = [
    ("arithmetic_in_version_1", "kBadOp", RESIZE, [("H", 10, 1)]),
    ("curve_in_version_1", "kBadActivation", L[4], [("H", 10, 1), *[("H", at, 11) for at in L[:4]], *[("I", at + 8, 2**32 - 1) for at in L[:5]],
                                                    *[("2H", at + 28, (0, 0)) for at in L[:4]], *[("H", at + 40, 0) for at in L[:4]],
                                                    *[("3I", at + 12, (1, 1, 12)) for at in L[:4]], ("2H", L[4], (9, 9)),
                                                    ("3I", L[4] + 12, (1, 1, 12)), ("H", L[4] + 42, 0)]),
    ("curve_of_another_layer", "kBadActivation", NORMALIZE, [("H", NORMALIZE + 2, 9)]),
    ("curve_unknown", "kBadActivation", SWISH, [("H", SWISH + 2, 15)]),
    ("resize_factor", "kBadShape", RESIZE + 12, [("H", RESIZE + 28, 0)]),
    ("resize_factor_of_no_whole_number", "kBadShape", OTHER_RESIZE + 12, [("H", OTHER_RESIZE + 30, 2)]),
    ("resize_channels", "kBadShape", RESIZE + 12, [("I", RESIZE + 20, 11)]),
    ("resize_to_nothing", "kBadShape", OTHER_RESIZE + 12, [("I", OTHER_RESIZE + 12, 0)]),
    ("resize_grid_unknown", "kBadKernel", RESIZE, [("H", RESIZE + 40, 3)]),
    ("resize_sampling_unknown", "kBadKernel", RESIZE, [("H", RESIZE + 40, 20)]),
    ("resize_kernel", "kBadKernel", RESIZE, [("H", RESIZE + 24, 1)]),
    ("resize_padding", "kBadKernel", RESIZE, [("H", RESIZE + 38, 1)]),
    ("resize_of_any_size_without_factor", "kBadOp", L[16], [("H", L[16] + 28, 0)]),
    ("rearrange_of_any_size", "kBadOp", L[17], [("H", L[17], 18), ("H", L[17] + 40, 0), ("2H", L[17] + 28, (0, 0))]),
    ("multiply_without_second_input", "kBadReference", MULTIPLY, [("I", MULTIPLY + 8, 2**32 - 1)]),
    ("multiply_by_a_larger_map", "kBadShape", MULTIPLY + 12, [("I", MULTIPLY + 8, 2)]),
    ("multiply_flags", "kBadKernel", MULTIPLY, [("H", MULTIPLY + 40, 1)]),
    ("multiply_activation", "kBadActivation", MULTIPLY, [("H", MULTIPLY + 2, 1)]),
    ("broadcast_add_of_other_channels", "kBadShape", ADD_BROADCAST + 12, [("I", ADD_BROADCAST + 4, 5), ("I", ADD_BROADCAST + 8, 4)]),
    ("divide_stride", "kBadKernel", DIVIDE, [("H", DIVIDE + 28, 1)]),
    ("divide_weights", "kBadTensor", DIVIDE + 48, [("I", DIVIDE + 48, 0)]),
    ("rearrange_order_unknown", "kBadKernel", REARRANGE, [("H", REARRANGE + 40, 6)]),
    ("rearrange_of_other_size", "kBadShape", REARRANGE + 12, [("I", REARRANGE + 20, 25)]),
    ("rearrange_wraps", "kBadShape", REARRANGE + 12, [("3I", REARRANGE + 12, (2**31, 2**31, 2**31))]),
    ("normalize_without_epsilon", "kBadActivation", NORMALIZE, [("f", NORMALIZE + 44, 0.0)]),
    ("normalize_epsilon_nan", "kBadActivation", NORMALIZE, [("f", NORMALIZE + 44, NAN)]),
    ("normalize_epsilon_one", "kBadActivation", NORMALIZE, [("f", NORMALIZE + 44, 1.0)]),
    ("outputs_15", "kBadNetwork", BIG + 32, [("I", BIG + 32, 15)]),
    ("narrow_output_zero", "kBadNetwork", OUTPUTS + 10, [("H", OUTPUTS + 10, 0)]),
    ("narrow_output_beyond", "kBadNetwork", OUTPUTS + 26, [("H", OUTPUTS + 26, 17)]),
    ("narrow_output_unused", "kBadNetwork", OUTPUTS + 26, [("I", BIG + 32, 13)]),
    ("wide_output_beyond_16_bits", "kBadNetwork", SMALL + 38, [("H", SMALL + 38, 1)]),
    ("wide_output_reserved", "kReservedNotZero", SMALL + 52, [("H", SMALL + 58, 1)]),
]

BOUNDS = (HERE / "accept/input_bounds.mien").read_bytes()
EXPAND, DEPTHWISE = 128, 192
BOUNDS_CASES = [
    ("bounds_in_version_2", "kReservedNotZero", EXPAND, [("H", 10, 2)]),
    ("bounds_of_no_layer", "kUnsupportedVersion", 10, [("I", EXPAND + 60, 0), ("I", EXPAND + 128 + 60, 0)]),
    ("bound_of_depthwise", "kReservedNotZero", DEPTHWISE, [("f", DEPTHWISE + 60, 6.0)]),
    ("bound_negative", "kBadActivation", EXPAND, [("f", EXPAND + 60, -1.0)]),
    ("bound_minus_zero", "kBadActivation", EXPAND, [("f", EXPAND + 60, -0.0)]),
    ("bound_too_small", "kBadActivation", EXPAND, [("f", EXPAND + 60, 2.0**-65)]),
    ("bound_too_large", "kBadActivation", EXPAND, [("f", EXPAND + 60, 2.0**65)]),
    ("bound_nan", "kBadActivation", EXPAND, [("f", EXPAND + 60, NAN)]),
    ("bound_infinite", "kBadActivation", EXPAND, [("f", EXPAND + 60, float("inf"))]),
]

# Changes of every_op.mien: name, layer, tensor, element (layers of the first network have 20 channels, in 24 lanes), new value.
WEIGHTS, BIAS, SLOPES = range(3)
LANES_CASES = [
    ("lane_of_conv2d", 0, WEIGHTS, 16 * 27 + 26 * 8 + 7, 0x3C00),
    ("lane_of_depthwise", 1, WEIGHTS, 2 * 9 * 8 + 8 * 8 + 4, 0x3C00),
    ("lane_of_pointwise_output", 3, WEIGHTS, 16 * 24 + 5 * 8 + 4, 0x3C00),
    ("lane_of_pointwise_input", 3, WEIGHTS, 20 * 16, 0x3C00),
    ("lane_of_fully_connected_output", 11, WEIGHTS, 13, 0x3C00),
    ("lane_of_fully_connected_first_pixel", 11, WEIGHTS, (16 * 2 + 4) * 16 + 12, 0x3C00),
    ("lane_of_fully_connected_last_pixel", 11, WEIGHTS, 47 * 16, 0x3C00),
    ("lane_of_causal_conv_previous", 13, WEIGHTS, 13 * 16, 0x3C00),
    ("lane_of_causal_conv_current", 13, WEIGHTS, 16 * 32 + 31 * 8, 0x3C00),
    ("lane_of_lstm", 14, WEIGHTS, 16 * 32 + 20 * 16 + 15, 0x3C00),
    ("lane_of_bias", 0, BIAS, 20, 0x3C00),
    ("lane_of_bias_denormal", 2, BIAS, 23, 0x0001),
    ("lane_of_slopes", 7, SLOPES, 21, 0x3C00),
    ("lane_of_slopes_minus_zero", 13, SLOPES, 20, 0x8000),
]


def lane_of(layer, tensor, element):
    """Where an element of a layer's tensor is in every_op.mien."""
    networks, layers = struct.unpack_from("<2I", EVERY_OP, 20)
    first_layer = 64 + 64 * networks
    index, = struct.unpack_from("<I", EVERY_OP, first_layer + 64 * layer + 48 + 4 * tensor)
    offset, = struct.unpack_from("<Q", EVERY_OP, first_layer + 64 * (layers + index) + 32)
    at = offset + 2 * element
    assert EVERY_OP[at:at + 2] == bytes(2)
    return at


def changed(changes, base=BASE):
    data = bytearray(base)
    for layout, offset, value in changes:
        struct.pack_into("<" + layout, data, offset, *(value if isinstance(value, tuple) else (value,)))
    return with_checksum(data)


def with_checksum(data):
    struct.pack_into("<Q", data, 56, 0)
    struct.pack_into("<Q", data, 56, xxhash64(bytes(data)))
    return bytes(data)


def longer(extra):
    return with_checksum(bytearray(BASE + extra))


def whole_file_cases():
    damaged = bytearray(BASE)
    damaged[DATA] ^= 1
    more = bytearray(BASE + bytes(64))
    struct.pack_into("<Q", more, 40, len(more))
    return [("damaged", "kBadChecksum", 56, bytes(damaged)),
            ("empty", "kTruncated", 0, b""),
            ("half_header", "kTruncated", 32, BASE[:32]),
            ("truncated", "kTruncated", len(BASE) - 1, BASE[:-1]),
            ("polyglot", "kTrailingBytes", len(BASE), longer(b"PK\x05\x06" + bytes(18))),
            ("hidden_at_end", "kHole", len(BASE), with_checksum(more)),
            ("text_file", "kBadMagic", 0, b"# not a weight file\n" * 4)]


def main():
    folder = HERE / "reject"
    for old in folder.glob("*.mien"):
        old.unlink()
    cases = [(name, status, changes[0][1] if offset is None else offset, changed(changes))
             for name, status, offset, changes in CASES] + whole_file_cases()
    cases += [(name, status, offset, changed(changes, PARTS)) for name, status, offset, changes in PARTS_CASES]
    cases += [(name, status, offset, changed(changes, ARITHMETIC)) for name, status, offset, changes in ARITHMETIC_CASES]
    cases += [(name, status, offset, changed(changes, BOUNDS)) for name, status, offset, changes in BOUNDS_CASES]
    for name, layer, tensor, element, value in LANES_CASES:
        at = lane_of(layer, tensor, element)
        cases.append((name, "kPaddingNotZero", at, changed([("H", at, value)], EVERY_OP)))
    for name, _, _, data in cases:
        (folder / f"{name}.mien").write_bytes(data)
    (folder / "expected.txt").write_text("".join(f"{name}.mien {status} {offset}\n" for name, status, offset, _ in cases))


if __name__ == "__main__":
    main()
