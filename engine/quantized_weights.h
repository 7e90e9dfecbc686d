// Quantized weights of the pointwise layers of fused blocks.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>

#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::engine {

// A pointwise layer of a fused block.
struct QuantizedLayer {
  std::int32_t in_c, out_c;
  bool is_quantized;  // otherwise its weights remain as they are
  bool reads_map;     // not a band
  float input_bound;  // 0: 16 bits, else 8
};

// Memory of the weights of one layer: integers, scales and, with 8 bits, sums.
[[nodiscard]] std::size_t quantized_weights_bytes(const QuantizedLayer& layer);

// Quantizes `weights` into that memory, which must be aligned for floats. Returns
// MIEN_ERROR_UNSUPPORTED_LAYER if no allowed tier has a kernel.
[[nodiscard]] mien_status quantize_weights(const QuantizedLayer& layer, std::uint32_t cpu_mask,
                                           std::byte* to,
                                           kernels::InvertedResidualArgs::Weights& weights);

}  // namespace mien::engine
