// The rules for each layer operation of a weight file: allowed fields, output shape, tensors, and
// the padding in them that must be zero.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/mien_file.h"
#include "formats/mien_format.h"

namespace mien::formats {

struct ValueShape {
  std::uint64_t height, width, channels;
  friend bool operator==(const ValueShape&, const ValueShape&) = default;
};

struct TensorDims {
  std::uint32_t rank = 0;  // 0: the layer has no such tensor
  std::uint64_t dim[kMaxRank] = {};
};

// Weights are padded to whole panels and blocks. The padding must be zero, because some kernels
// include it in their sums and others do not.

// Layout of a layer's fp16 tensor: [panel][step][output of the panel].
struct TensorLanes {
  std::uint64_t outputs = 0;       // used outputs; the tensor has padded8 of them
  std::uint64_t panel = 0;         // outputs per panel; the last panel may have 8
  std::uint64_t steps = 0;         // length of each output's reduction
  std::uint64_t maps = 0;          // blocked maps at the start of the reduction
  std::uint64_t pixels = 0;        // per map
  std::uint64_t map_channels = 0;  // used channels of a map, which has padded8 of them
};

struct LayerTensor {
  TensorDims dims;
  TensorLanes lanes;  // only valid with dims
};

struct LayerTensors {
  LayerTensor weights, bias, slopes;
};

[[nodiscard]] constexpr std::uint64_t padded8(std::uint64_t n) { return (n + 7) / 8 * 8; }

[[nodiscard]] constexpr LayerOp op_of(const LayerRecord& layer) {
  return static_cast<LayerOp>(layer.op);
}

// The declared shape of a layer's output.
[[nodiscard]] constexpr ValueShape shape_of(const LayerRecord& layer) {
  return {layer.height, layer.width, layer.channels};
}

// Whether the op has two inputs.
[[nodiscard]] constexpr bool takes_two(LayerOp op) {
  return op == LayerOp::kAdd || op == LayerOp::kConcat || op == LayerOp::kMultiply ||
         op == LayerOp::kDivide || op == LayerOp::kBroadcastAdd;
}

// The minor version of the format that a layer requires.
[[nodiscard]] constexpr std::uint16_t version_needed(LayerOp op) {
  return op >= LayerOp::kMultiply ? 2 : op >= LayerOp::kGlobalAveragePool ? 1 : 0;
}
[[nodiscard]] constexpr std::uint16_t version_needed(LayerActivation activation) {
  return activation >= LayerActivation::kHardSwish ? 2 : 0;
}
[[nodiscard]] constexpr std::uint16_t version_needed(const LayerRecord& layer) {
  const std::uint16_t activation = version_needed(static_cast<LayerActivation>(layer.activation));
  const bool has_bound = std::bit_cast<std::uint32_t>(layer.input_bound) != 0;
  return has_bound ? 3 : activation > 0 ? activation : version_needed(op_of(layer));
}

// The minor version of the format that a network's record requires.
[[nodiscard]] constexpr std::uint16_t version_needed(const NetworkRecord& network) {
  return network.output_count > kMaxWideOutputs ? 2 : 0;
}

// Checks that outputs are distinct values of the network and that unused elements are zero.
// `place`: index of the wrong element of NetworkRecord::outputs; kNoIndex if the count is wrong.
[[nodiscard]] mien_status check_outputs(const NetworkRecord& network, std::uint16_t minor_version,
                                        std::uint32_t& place);

// Whether all dimensions are in 1..kMaxDim and the blocked map is within kMaxMapElems.
[[nodiscard]] bool shape_allowed(ValueShape shape);

// Whether an input bound other than 0 is within its limits.
[[nodiscard]] bool input_bound_allowed(const LayerRecord& layer);

// Checks a layer's fields: op, activation, references below `value`, kernel, strides, padding.
// `minor_version`: that of the file.
[[nodiscard]] mien_status check_layer(const LayerRecord& layer, std::uint32_t value,
                                      std::uint32_t network_flags, std::uint16_t minor_version);

// The output shape of a checked layer for these inputs, of the declared size or another. Ignores
// the declared height and width, except for ops whose inputs do not determine them. `second`: only
// for ops with two inputs. Zeros if the layer does not accept the inputs.
[[nodiscard]] ValueShape output_shape(const LayerRecord& layer, ValueShape input,
                                      ValueShape second);

// The same for the declared inputs, to which the factors of kResize must apply.
[[nodiscard]] ValueShape declared_output_shape(const LayerRecord& layer, ValueShape input,
                                               ValueShape second);

// kResize: the factor from input to output rows or columns; 0 if it is not a whole number.
[[nodiscard]] constexpr std::uint16_t resize_factor(std::uint64_t from, std::uint64_t to) {
  constexpr std::uint64_t kMax = 0xFFFF;
  return from != 0 && to % from == 0 && to / from <= kMax ? static_cast<std::uint16_t>(to / from)
                                                          : std::uint16_t{0};
}

// The tensors of a checked layer with this input.
[[nodiscard]] LayerTensors tensors_of(const LayerRecord& layer, ValueShape input);

// Offset in bytes of a padding element that is not +0; the tensor's size if all are.
[[nodiscard]] std::size_t find_filled(const TensorLanes& lanes, std::span<const std::byte> tensor);

}  // namespace mien::formats
