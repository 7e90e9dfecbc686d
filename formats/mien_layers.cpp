#include "formats/mien_layers.h"

#include <cmath>

namespace mien::formats {
namespace {

LayerOp op_of(const LayerRecord& layer) { return static_cast<LayerOp>(layer.op); }

LayerActivation activation_of(const LayerRecord& layer) {
  return static_cast<LayerActivation>(layer.activation);
}

bool slides(LayerOp op) {
  return op == LayerOp::kConv2d || op == LayerOp::kDepthwise || op == LayerOp::kMaxPool;
}

// Cells, sums and softmax have their own nonlinearity or none.
bool may_activate(LayerOp op) {
  return op != LayerOp::kLstm && op != LayerOp::kMaxPool && op != LayerOp::kAdd &&
         op != LayerOp::kSoftmax;
}

FileStatus check_activation(const LayerRecord& layer) {
  const bool known = layer.activation <= static_cast<std::uint16_t>(LayerActivation::kClamp01);
  if (!known || (layer.activation != 0 && !may_activate(op_of(layer)))) {
    return FileStatus::kBadActivation;
  }
  const bool leaky = activation_of(layer) == LayerActivation::kLeakyRelu;
  // Written so that a NaN fails; zero is compared by value, -0.0 is not admitted.
  const bool plain_zero = layer.alpha == 0.0f && !std::signbit(layer.alpha);
  if (leaky ? !(layer.alpha >= 0.0f && layer.alpha <= 1.0f) : !plain_zero) {
    return FileStatus::kBadActivation;
  }
  return FileStatus::kOk;
}

FileStatus check_window(const LayerRecord& layer) {
  const auto between = [](std::uint16_t value, std::uint16_t low, std::uint16_t high) {
    return value >= low && value <= high;
  };
  const std::uint16_t pads[4] = {layer.pad_top, layer.pad_left, layer.pad_bottom, layer.pad_right};
  bool good = true;
  if (slides(op_of(layer))) {
    good =
        between(layer.kernel_height, 1, kMaxKernel) && between(layer.kernel_width, 1, kMaxKernel) &&
        between(layer.stride_height, 1, kMaxStride) && between(layer.stride_width, 1, kMaxStride);
    for (int i = 0; i < 4; ++i) {
      const std::uint16_t kernel = i % 2 == 0 ? layer.kernel_height : layer.kernel_width;
      good = good && pads[i] < kernel;  // no window sees padding alone
    }
  } else {
    good = layer.kernel_height == 0 && layer.kernel_width == 0 && layer.stride_height == 0 &&
           layer.stride_width == 0;
    for (const std::uint16_t pad : pads) {
      good = good && pad == 0;
    }
  }
  const std::uint16_t allowed_flags = op_of(layer) == LayerOp::kMaxPool ? kCeilMode : 0;
  return good && layer.flags <= allowed_flags ? FileStatus::kOk : FileStatus::kBadKernel;
}

TensorDims vector_of(std::uint64_t n) { return {1, {n}}; }

TensorDims weights_of(const LayerRecord& layer, ValueShape input) {
  const std::uint64_t out = padded8(layer.channels);
  const std::uint64_t blocked = padded8(input.channels);
  switch (op_of(layer)) {
    case LayerOp::kConv2d:
      return {4, {out, layer.kernel_height, layer.kernel_width, input.channels}};
    case LayerOp::kDepthwise:
      return {3, {out, layer.kernel_height, layer.kernel_width}};
    case LayerOp::kPointwise:
      return {2, {out, blocked}};
    case LayerOp::kFullyConnected:
      return {2, {out, blocked * input.height * input.width}};
    case LayerOp::kCausalConv:
      return {3, {out, 2, blocked}};
    case LayerOp::kLstm:
      return {2, {4 * out, blocked + out}};
    case LayerOp::kMaxPool:
    case LayerOp::kAdd:
    case LayerOp::kActivation:
    case LayerOp::kSoftmax:
      break;
  }
  return {};
}

}  // namespace

FileStatus check_layer(const LayerRecord& layer, std::uint32_t value) {
  if (layer.op < static_cast<std::uint16_t>(LayerOp::kConv2d) ||
      layer.op > static_cast<std::uint16_t>(LayerOp::kSoftmax)) {
    return FileStatus::kBadOp;
  }
  if (layer.reserved != 0 || layer.reserved_tail != 0) {
    return FileStatus::kReservedNotZero;
  }
  const bool adds = op_of(layer) == LayerOp::kAdd;
  if (layer.input >= value ||
      (adds ? layer.second_input >= value : layer.second_input != kNoIndex)) {
    return FileStatus::kBadReference;
  }
  for (const std::uint32_t dim : {layer.height, layer.width, layer.channels}) {
    if (dim == 0 || dim > kMaxDim) {
      return FileStatus::kBadShape;
    }
  }
  const std::uint64_t plane = std::uint64_t{layer.height} * layer.width;
  if (plane * padded8(layer.channels) > kMaxFileBytes / sizeof(float)) {
    return FileStatus::kBadShape;
  }
  const FileStatus activation = check_activation(layer);
  return activation != FileStatus::kOk ? activation : check_window(layer);
}

LayerTensors tensors_of(const LayerRecord& layer, ValueShape input) {
  LayerTensors tensors;
  tensors.dims[0] = weights_of(layer, input);
  const std::uint64_t out = padded8(layer.channels);
  if (tensors.dims[0].rank != 0) {
    tensors.dims[1] = vector_of(op_of(layer) == LayerOp::kLstm ? 4 * out : out);
  }
  if (activation_of(layer) == LayerActivation::kPrelu) {
    tensors.dims[2] = vector_of(out);
  }
  return tensors;
}

}  // namespace mien::formats
