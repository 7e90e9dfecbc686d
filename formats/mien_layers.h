// What each layer operation of a weight file may look like, its output's shape, and the tensors it
// owns.
#pragma once

#include <cstdint>

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

struct LayerTensors {
  TensorDims weights, bias, slopes;
};

[[nodiscard]] constexpr std::uint64_t padded8(std::uint64_t n) { return (n + 7) / 8 * 8; }

[[nodiscard]] constexpr LayerOp op_of(const LayerRecord& layer) {
  return static_cast<LayerOp>(layer.op);
}

// The declared shape of a layer's output.
[[nodiscard]] constexpr ValueShape shape_of(const LayerRecord& layer) {
  return {layer.height, layer.width, layer.channels};
}

// Whether the op reads a second value.
[[nodiscard]] constexpr bool takes_two(LayerOp op) {
  return op == LayerOp::kAdd || op == LayerOp::kConcat;
}

// The minor version of the format that a layer needs.
[[nodiscard]] constexpr std::uint16_t version_needed(const LayerRecord& layer) {
  return layer.op >= static_cast<std::uint16_t>(LayerOp::kGlobalAveragePool) ? 1 : 0;
}

// All dimensions in 1..kMaxDim and the map, blocked, within kMaxMapElems.
[[nodiscard]] bool shape_allowed(ValueShape shape);

// Fields by themselves: op, activation, references below `value`, kernel, strides, padding.
// `minor_version`: the file's.
[[nodiscard]] FileStatus check_layer(const LayerRecord& layer, std::uint32_t value,
                                     std::uint32_t network_flags, std::uint16_t minor_version);

// The output of a checked layer for these inputs, its declared height and width aside; `second`
// counts for ops that take two. Zeros where the layer cannot take such inputs.
[[nodiscard]] ValueShape output_shape(const LayerRecord& layer, ValueShape input,
                                      ValueShape second);

// The tensors of a checked layer with this input.
[[nodiscard]] LayerTensors tensors_of(const LayerRecord& layer, ValueShape input);

}  // namespace mien::formats
