// Converts weights in PyTorch's layout to the packed fp16 tensors of docs/format.md, for writers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mien::formats {

using Halves = std::vector<std::uint16_t>;

// For each step k of a reduction, the index in an output's row; kZero stands for padding.
using ReductionOrder = std::vector<std::size_t>;
inline constexpr std::size_t kZero = static_cast<std::size_t>(-1);

ReductionOrder conv2d_order(std::size_t channels, std::size_t taps);
ReductionOrder map_order(std::size_t channels, std::size_t pixels);  // blocked [h][w][c]
ReductionOrder causal_conv_order(std::size_t channels);
ReductionOrder lstm_order(std::size_t inputs, std::size_t hidden);  // rows [inputs + hidden]

// values [outputs][row] -> panels of 16 outputs, [panel][k][16]; the last may be 8 wide.
Halves pack_panels(std::span<const float> values, std::size_t outputs, const ReductionOrder& order);

// values [channels][taps] -> [block][taps][8]
Halves pack_depthwise(std::span<const float> values, std::size_t channels, std::size_t taps);

// Pads with zeros to a multiple of 8.
Halves pack_vector(std::span<const float> values);

}  // namespace mien::formats
