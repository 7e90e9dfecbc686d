// Shape inference and cost of each layer operation.
#include "engine/shape.h"

namespace mien::engine {

using formats::LayerOp;
using formats::LayerRecord;

namespace {

LayerOp op_of(const LayerRecord& layer) { return static_cast<LayerOp>(layer.op); }

// Number of window positions along one axis, 0 if the window does not fit.
std::int32_t windows(std::int32_t size, std::int32_t kernel, std::int32_t stride,
                     std::int32_t padding, bool ceil_mode) {
  const std::int32_t travel = size + padding - kernel;
  if (travel < 0) {
    return 0;
  }
  return (travel + (ceil_mode ? stride - 1 : 0)) / stride + 1;
}

Shape windowed(const LayerRecord& l, const Shape& input, std::int32_t channels) {
  const bool ceil_mode = (l.flags & formats::kCeilMode) != 0;
  return {windows(input.h, l.kernel_height, l.stride_height, l.pad_top + l.pad_bottom, ceil_mode),
          windows(input.w, l.kernel_width, l.stride_width, l.pad_left + l.pad_right, ceil_mode),
          channels};
}

// The last window of a pool must begin on the map or its leading padding.
bool pool_windows_hold_values(const LayerRecord& l, const Shape& input, const Shape& output) {
  return (output.h - 1) * l.stride_height < input.h + l.pad_top &&
         (output.w - 1) * l.stride_width < input.w + l.pad_left;
}

bool is_centre_slice(const Shape& small, const Shape& large) {
  return small.c == large.c && small.h <= large.h && small.w <= large.w &&
         (large.h - small.h) % 2 == 0 && (large.w - small.w) % 2 == 0;
}

bool is_broadcast(std::int32_t from, std::int32_t to) { return from == to || from == 1; }

bool is_broadcast(const Shape& b, const Shape& a) {
  return is_broadcast(b.h, a.h) && is_broadcast(b.w, a.w) && is_broadcast(b.c, a.c);
}

// A factor of 0 selects the declared size. The product saturates, which fails is_allowed.
std::int32_t resized(std::int32_t size, std::int32_t factor, std::uint32_t declared) {
  const std::int64_t all = factor == 0 ? std::int64_t{declared} : std::int64_t{size} * factor;
  return static_cast<std::int32_t>(all <= INT32_MAX ? all : INT32_MAX);
}

}  // namespace

bool is_allowed(const Shape& shape) {
  const auto u64 = [](std::int32_t n) { return static_cast<std::uint64_t>(n); };
  const std::uint64_t pixels = u64(shape.h) * u64(shape.w);
  return pixels <= formats::kMaxMapElems / ((u64(shape.c) + 7) / 8 * 8);
}

mien_status infer_shape(const LayerRecord& layer, const Shape& input, const Shape& second,
                        Shape& output) {
  const std::int32_t channels = static_cast<std::int32_t>(layer.channels);
  const bool is_vector = input.h == 1 && input.w == 1;
  bool suits = true;
  switch (op_of(layer)) {
    case LayerOp::kConv2d:
      output = windowed(layer, input, channels);
      break;
    case LayerOp::kDepthwise:
      output = windowed(layer, input, input.c);
      break;
    case LayerOp::kMaxPool:
      output = windowed(layer, input, input.c);
      suits = pool_windows_hold_values(layer, input, output);
      break;
    case LayerOp::kPointwise:
      output = {input.h, input.w, channels};
      break;
    case LayerOp::kFullyConnected:
      output = {1, 1, channels};
      break;
    case LayerOp::kCausalConv:
      output = {1, 1, channels};
      suits = is_vector;
      break;
    case LayerOp::kLstm:
      output = {1, 1, channels};
      suits = is_vector && channels % 8 == 0;
      break;
    case LayerOp::kAdd:
      output = input;
      suits = is_centre_slice(input, second);
      break;
    case LayerOp::kMultiply:
    case LayerOp::kDivide:
    case LayerOp::kBroadcastAdd:
      output = input;
      suits = is_broadcast(second, input);
      break;
    case LayerOp::kResize:
      output = {resized(input.h, layer.stride_height, layer.height),
                resized(input.w, layer.stride_width, layer.width), input.c};
      break;
    case LayerOp::kRearrange:
      output = {static_cast<std::int32_t>(layer.height), static_cast<std::int32_t>(layer.width),
                channels};
      suits = output.pixels() * static_cast<std::size_t>(output.c) ==
              input.pixels() * static_cast<std::size_t>(input.c);
      break;
    case LayerOp::kActivation:
    case LayerOp::kSoftmax:
    case LayerOp::kNormalize:
      output = input;
      break;
    case LayerOp::kGlobalAveragePool:
      output = {1, 1, input.c};
      break;
    case LayerOp::kConcat:
      output = {input.h, input.w, input.c + second.c};
      suits = input.h == second.h && input.w == second.w;
      break;
    case LayerOp::kSlice:
      output = {input.h - layer.pad_top - layer.pad_bottom,
                input.w - layer.pad_left - layer.pad_right, channels};
      suits = channels <= input.c - layer.first_channel;
      break;
  }
  return suits && output.h > 0 && output.w > 0 ? MIEN_OK : MIEN_ERROR_WEIGHTS_LAYER_SHAPE;
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
