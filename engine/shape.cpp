// Shapes of maps and the cost of each layer operation.
#include "engine/shape.h"

#include <algorithm>

#include "formats/mien_layers.h"

namespace mien::engine {

using formats::LayerOp;
using formats::LayerRecord;

namespace {

formats::ValueShape value_shape(const Shape& shape) {
  const auto u64 = [](std::int32_t n) { return static_cast<std::uint64_t>(n); };
  return {u64(shape.h), u64(shape.w), u64(shape.c)};
}

// Saturates, which fails is_allowed.
std::int32_t dimension(std::uint64_t n) {
  return static_cast<std::int32_t>(std::min<std::uint64_t>(n, INT32_MAX));
}

}  // namespace

bool is_allowed(const Shape& shape) {
  const auto u64 = [](std::int32_t n) { return static_cast<std::uint64_t>(n); };
  const std::uint64_t pixels = u64(shape.h) * u64(shape.w);
  return pixels <= formats::kMaxMapElems / ((u64(shape.c) + 7) / 8 * 8);
}

mien_status infer_shape(const LayerRecord& layer, const Shape& input, const Shape& second,
                        Shape& output) {
  const formats::ValueShape shape =
      formats::output_shape(layer, value_shape(input), value_shape(second));
  output = {dimension(shape.height), dimension(shape.width), dimension(shape.channels)};
  return output.h > 0 && output.w > 0 ? MIEN_OK : MIEN_ERROR_WEIGHTS_LAYER_SHAPE;
}

LayerCost layer_cost(const LayerRecord& layer, const Shape& input, const Shape& output) {
  const auto u64 = [](std::int32_t n) { return static_cast<std::uint64_t>(n); };
  const std::uint64_t window = std::uint64_t{layer.kernel_height} * layer.kernel_width;
  const std::uint64_t in = u64(input.c), out = u64(output.c), positions = output.pixels();
  const bool has_slopes = layer.slopes != formats::kNoIndex;
  LayerCost cost;
  const auto dense = [&](std::uint64_t weights, std::uint64_t biases, std::uint64_t uses) {
    cost = {weights + biases + (has_slopes ? out : 0), weights * uses};
  };
  switch (op_of(layer)) {
    case LayerOp::kConv2d:
      dense(window * in * out, out, positions);
      break;
    case LayerOp::kDepthwise:
      dense(window * out, out, positions);
      break;
    case LayerOp::kPointwise:
      dense(in * out, out, positions);
      break;
    case LayerOp::kFullyConnected:
      dense(input.pixels() * in * out, out, 1);
      break;
    case LayerOp::kCausalConv:
      dense(2 * in * out, out, 1);
      break;
    case LayerOp::kLstm:
      dense(4 * out * (in + out), 4 * out, 1);
      break;
    case LayerOp::kMaxPool:
    case LayerOp::kAdd:
    case LayerOp::kActivation:
    case LayerOp::kSoftmax:
    case LayerOp::kGlobalAveragePool:
    case LayerOp::kConcat:
    case LayerOp::kSlice:
    case LayerOp::kMultiply:
    case LayerOp::kDivide:
    case LayerOp::kBroadcastAdd:
    case LayerOp::kResize:
    case LayerOp::kRearrange:
    case LayerOp::kNormalize:
      cost.parameters = has_slopes ? out : 0;
      break;
  }
  return cost;
}

}  // namespace mien::engine
