// Lays quantized weights out in memory and calls the kernels that compute them.
#include "engine/quantized_weights.h"

#include "engine/arena_plan.h"
#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::engine {
namespace {

using Weights = kernels::InvertedResidualArgs::Weights;

std::int32_t blocks_of(std::int32_t channels) { return (channels + 7) / 8; }

// Integers of all outputs.
std::ptrdiff_t int16_count(const QuantizedLayer& layer) {
  return std::ptrdiff_t{blocks_of(layer.in_c)} * blocks_of(layer.out_c) * 64;
}
std::ptrdiff_t int8_count(const QuantizedLayer& layer) {
  return std::ptrdiff_t{layer.in_c + 15} / 16 * 16 * blocks_of(layer.out_c) * 8;
}

template <class Args>
Args args_of(const QuantizedLayer& layer, const Weights& weights) {
  Args args{};
  args.in_blocks = blocks_of(layer.in_c);
  args.out_blocks = blocks_of(layer.out_c);
  args.weights = weights.weights;
  return args;
}

template <class Args>
mien_status run(const Args& args, std::uint32_t cpu_mask) {
  const auto kernel = kernels::find<Args>(cpu_mask);
  if (kernel == nullptr) {
    return MIEN_ERROR_UNSUPPORTED_LAYER;
  }
  kernel(args);
  return MIEN_OK;
}

mien_status to_int16(const QuantizedLayer& layer, std::uint32_t cpu_mask, std::byte* to,
                     Weights& weights) {
  auto args = args_of<kernels::QuantizeWeightsArgs>(layer, weights);
  args.pairs = reinterpret_cast<std::int16_t*>(to);
  args.scales = reinterpret_cast<float*>(args.pairs + int16_count(layer));
  args.max_value = layer.reads_map ? kernels::kQuantizedMapMax : kernels::kQuantizedBandMax;
  args.is_signed = layer.reads_map;
  weights.pairs = args.pairs;
  weights.scales = args.scales;
  return run(args, cpu_mask);
}

mien_status to_int8(const QuantizedLayer& layer, std::uint32_t cpu_mask, std::byte* to,
                    Weights& weights) {
  auto args = args_of<kernels::QuantizeToInt8Args>(layer, weights);
  args.quads = reinterpret_cast<std::int8_t*>(to);
  // Only fused blocks have 8 bits, so some tier computes them.
  args.panel = kernels::int8_panel(
      kernels::find_entry(kernels::InvertedResidualArgs::kFamily, cpu_mask)->tier);
  args.scales = reinterpret_cast<float*>(to + int8_count(layer));
  args.sums = args.scales + std::ptrdiff_t{args.out_blocks} * 8;
  weights.quads = args.quads;
  weights.scales = args.scales;
  weights.sums = args.sums;
  weights.input_bound = layer.input_bound;
  return run(args, cpu_mask);
}

}  // namespace

std::size_t quantized_weights_bytes(const QuantizedLayer& layer) {
  if (!layer.is_quantized) {
    return 0;
  }
  const std::size_t floats = static_cast<std::size_t>(blocks_of(layer.out_c)) * 8 * sizeof(float);
  return layer.input_bound > 0.0f
             ? aligned(static_cast<std::size_t>(int8_count(layer)) + 2 * floats)
             : aligned(static_cast<std::size_t>(int16_count(layer)) * sizeof(std::int16_t) +
                       floats);
}

mien_status quantize_weights(const QuantizedLayer& layer, std::uint32_t cpu_mask, std::byte* to,
                             Weights& weights) {
  if (!layer.is_quantized) {
    return MIEN_OK;
  }
  return layer.input_bound > 0.0f ? to_int8(layer, cpu_mask, to, weights)
                                  : to_int16(layer, cpu_mask, to, weights);
}

}  // namespace mien::engine
