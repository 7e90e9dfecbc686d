// Inverted residual blocks: layers that run as one step.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/shape.h"

namespace mien::engine {

// How a fused block divides its work, as kernels/inverted_residual/inverted_residual.h has it.
struct BlockTiling {
  std::int32_t band_rows;
  std::int32_t strip_channels, strip_rows, strip_w;
  std::size_t band_elems, strip_elems, half_input_elems;  // floats

  [[nodiscard]] std::size_t scratch_elems() const;  // with what weights in fp32 take
};

// `slide` is the depthwise layer, from `hidden` to `slid`. `half_input_c`: channels of the block's
// input if it is expanded in half precision, else 0.
[[nodiscard]] BlockTiling tile_block(const formats::LayerRecord& depthwise_layer,
                                     const Shape& hidden, const Shape& depthwise_output,
                                     std::int32_t half_input_c);

// Whether the tiers of `cpu_mask` run blocks at least as fast fused as layer by layer; never
// without MIEN_CPU_FUSED.
[[nodiscard]] bool fuses_blocks(std::uint32_t cpu_mask);

// Whether fused blocks are computed in half precision.
[[nodiscard]] bool uses_half_precision(std::uint32_t cpu_mask);

// Whether fused blocks want their pointwise weights in fixed point, too (up to
// kernels::kQuantizedWeightsMaxInputs), and what such a layer's take: steps, then pairs.
[[nodiscard]] bool quantizes_weights(std::uint32_t cpu_mask);
[[nodiscard]] std::size_t quantized_weights_bytes(std::int32_t in_c, std::int32_t out_c);

// Whether a fused block can have this activation.
[[nodiscard]] bool fuses(const formats::LayerRecord& layer);

}  // namespace mien::engine
