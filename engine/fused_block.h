// Inverted residual blocks whose layers run as one step.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/shape.h"

namespace mien::engine {

// How a fused block divides its work; see kernels/inverted_residual/inverted_residual.h.
struct BlockTiling {
  std::int32_t band_rows;
  std::int32_t strip_channels, strip_rows, strip_w;
  std::size_t band_elems, strip_elems, half_input_elems;  // floats

  [[nodiscard]] std::size_t scratch_elems() const;  // including fp32_weights
};

// `hidden`, `depthwise_output`: shapes before and after `depthwise_layer`. `half_input_c`: channels
// of the block's input if its expand layer runs in half precision, else 0.
[[nodiscard]] BlockTiling tile_block(const formats::LayerRecord& depthwise_layer,
                                     const Shape& hidden, const Shape& depthwise_output,
                                     std::int32_t half_input_c);

// Whether the tiers of `cpu_mask` run fused blocks at least as fast as single layers; false without
// MIEN_CPU_FUSED.
[[nodiscard]] bool fuses_blocks(std::uint32_t cpu_mask);

// Whether fused blocks use half precision.
[[nodiscard]] bool uses_half_precision(std::uint32_t cpu_mask);

// Whether fused blocks use pointwise weights of 16 bits, for layers of up to
// kernels::kQuantizedWeightsMaxInputs inputs, and of 8 bits for those with an input bound.
[[nodiscard]] bool quantizes_weights(std::uint32_t cpu_mask);
[[nodiscard]] bool has_int8(std::uint32_t cpu_mask);

// Whether a fused block supports this layer's activation.
[[nodiscard]] bool fuses(const formats::LayerRecord& layer);

}  // namespace mien::engine
