// What the format says about one layer: its output's shape and the tensors it must have.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "formats/mien_format.h"

namespace mien::formats {

constexpr std::uint64_t round_up_8(std::uint64_t n) { return (n + 7) / 8 * 8; }

// Ops that have a weight and a bias.
bool has_weight(LayerOp op);

// Whether kernel, strides and padding are what the op allows; ops without a window have kernel 1,
// stride 1, padding 0.
bool geometry_allowed(const LayerRecord& layer);

// Shape of the output for inputs of shape `a` and, for kAdd, `b`; nothing where the op cannot take
// such inputs. Uses op, geometry and output.channels of the layer and not its declared height and
// width, so that it also answers for sizes other than the declared one.
std::optional<Shape> output_shape(const LayerRecord& layer, Shape a, Shape b);

// Dimensions of a packed tensor, 1 behind the rank.
struct Dims {
  std::uint16_t rank;
  std::array<std::uint64_t, kMaxRank> dims;
};
Dims weight_dims(const LayerRecord& layer, Shape input);  // only for ops with a weight
Dims bias_dims(const LayerRecord& layer);                 // only for ops with a weight
Dims slope_dims(const LayerRecord& layer);

}  // namespace mien::formats
