// What each layer operation of a weight file may look like, and which tensors it owns.
#pragma once

#include <cstdint>

#include "formats/mien_file.h"
#include "formats/mien_format.h"

namespace mien::formats {

struct ValueShape {
  std::uint64_t height, width, channels;
};

struct TensorDims {
  std::uint32_t rank = 0;  // 0: the layer has no such tensor
  std::uint64_t dim[kMaxRank] = {};
};

struct LayerTensors {
  TensorDims dims[3];  // weights, bias, slopes
};

[[nodiscard]] constexpr std::uint64_t padded8(std::uint64_t n) { return (n + 7) / 8 * 8; }

[[nodiscard]] constexpr ValueShape shape_of(const LayerRecord& layer) {
  return {layer.height, layer.width, layer.channels};
}

// Fields by themselves: op, activation, references below `value`, kernel, strides, padding, shape.
[[nodiscard]] FileStatus check_layer(const LayerRecord& layer, std::uint32_t value);

// The tensors of a checked layer with this input.
[[nodiscard]] LayerTensors tensors_of(const LayerRecord& layer, ValueShape input);

}  // namespace mien::formats
