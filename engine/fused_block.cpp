// Chooses tile sizes and tiers for fused inverted residual blocks.
#include "engine/fused_block.h"

#include <algorithm>

#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::engine {

using formats::LayerActivation;

namespace {

// A band fits the second-level cache, a strip the first, which has 48 KB on current CPUs.
constexpr std::int64_t kBandBytes = std::int64_t{256} * 1024;
constexpr std::int64_t kStripBytes = std::int64_t{36} * 1024;

// The number of channels whose sums fill the registers: the fewer pixels, the more channels.
std::int32_t channels_at_once(std::size_t pixels) {
  return pixels <= 6 ? 64 : pixels <= 9 ? 48 : 32;
}

}  // namespace

std::size_t BlockTiling::scratch_elems() const {
  return band_elems + strip_elems + half_input_elems + kernels::kInvertedResidualFp32WeightElems;
}

BlockTiling tile_block(const formats::LayerRecord& depthwise_layer, const Shape& hidden,
                       const Shape& depthwise_output, std::int32_t half_input_c) {
  BlockTiling t{};
  const std::int32_t kernel_h = depthwise_layer.kernel_height,
                     stride_h = depthwise_layer.stride_height;
  const std::size_t channels = (static_cast<std::size_t>(hidden.c) + 15) / 16 * 16;
  const std::size_t band_row = channels * static_cast<std::size_t>(depthwise_output.w);
  const auto rows_in = [](std::int64_t bytes, std::size_t row_elems) {
    return bytes / static_cast<std::int64_t>(row_elems * sizeof(float));
  };
  t.band_rows = static_cast<std::int32_t>(
      std::clamp<std::int64_t>(rows_in(kBandBytes, band_row), 1, depthwise_output.h));
  t.strip_channels =
      std::min(channels_at_once(hidden.pixels()), static_cast<std::int32_t>(channels));
  t.strip_w = std::max(
      depthwise_layer.pad_left + hidden.w,
      (depthwise_output.w - 1) * depthwise_layer.stride_width + depthwise_layer.kernel_width);
  const std::size_t strip_row =
      static_cast<std::size_t>(t.strip_channels) * static_cast<std::size_t>(t.strip_w);
  const std::int64_t extra = (rows_in(kStripBytes, strip_row) - kernel_h) / stride_h;
  t.strip_rows = kernel_h + stride_h * static_cast<std::int32_t>(
                                           std::clamp<std::int64_t>(extra, 0, t.band_rows - 1));
  t.band_elems = band_row * static_cast<std::size_t>(t.band_rows);
  t.strip_elems = strip_row * static_cast<std::size_t>(t.strip_rows);
  const std::int32_t rows = std::min(hidden.h, (t.band_rows - 1) * stride_h + kernel_h);
  t.half_input_elems = (static_cast<std::size_t>(half_input_c) + 31) / 32 * 16 *
                       static_cast<std::size_t>(rows) * static_cast<std::size_t>(hidden.w);
  return t;
}

bool fuses_blocks(std::uint32_t cpu_mask) {
  const kernels::Entry* fused =
      kernels::find_entry(kernels::InvertedResidualArgs::kFamily, cpu_mask);
  const kernels::Entry* plain = kernels::find_entry(kernels::PointwiseArgs::kFamily, cpu_mask);
  const bool allowed = (cpu_mask & kernels::kFusedBlocks) != 0;
  return allowed && fused != nullptr && plain != nullptr &&
         kernels::rank(fused->tier) >= kernels::rank(plain->tier);
}

bool uses_half_precision(std::uint32_t cpu_mask) {
  const kernels::Entry* fused =
      kernels::find_entry(kernels::InvertedResidualArgs::kFamily, cpu_mask);
  return fused != nullptr && kernels::is_half(fused->tier);
}

bool quantizes_weights(std::uint32_t cpu_mask) {
  const kernels::Entry* fused =
      kernels::find_entry(kernels::InvertedResidualArgs::kFamily, cpu_mask);
  return fused != nullptr && kernels::is_quantized(fused->tier);
}

bool has_int8(std::uint32_t cpu_mask) {
  const kernels::Entry* fused =
      kernels::find_entry(kernels::InvertedResidualArgs::kFamily, cpu_mask);
  return fused != nullptr && kernels::has_int8(fused->tier);
}

bool fuses(const formats::LayerRecord& layer) {
  switch (static_cast<LayerActivation>(layer.activation)) {
    case LayerActivation::kNone:
    case LayerActivation::kRelu:
    case LayerActivation::kRelu6:
    case LayerActivation::kClamp01:
      return true;
    default:
      return false;
  }
}

}  // namespace mien::engine
