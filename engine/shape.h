// Shapes of maps, shape inference and the cost of a layer.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>

#include "formats/mien_format.h"

namespace mien::engine {

struct Shape {
  std::int32_t h = 0, w = 0, c = 0;

  friend bool operator==(const Shape&, const Shape&) = default;
  // True for a camera crop: few channels, stored [h][w][c]. Other maps are in blocks of 8 channels.
  [[nodiscard]] bool interleaved() const { return c <= 4 && (h > 1 || w > 1); }
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(h) * static_cast<std::size_t>(w);
  }
};

// Floats of a blocked map, unused lanes included.
[[nodiscard]] inline std::size_t blocked_elems(const Shape& shape) {
  return shape.pixels() * ((static_cast<std::size_t>(shape.c) + 7) / 8 * 8);
}

// Whether the blocked map is within formats::kMaxMapElems, the limit of declared maps.
[[nodiscard]] bool is_allowed(const Shape& shape);

// Computes the output shape of a layer. `second` is the second input, for layers that have two.
// Returns MIEN_ERROR_WEIGHTS_LAYER_SHAPE if the layer does not accept the input.
[[nodiscard]] mien_status infer_shape(const formats::LayerRecord& layer, const Shape& input,
                                      const Shape& second, Shape& output);

// Cost of a layer, counting channels as declared, not as padded.
struct LayerCost {
  std::uint64_t parameters = 0;
  std::uint64_t macs = 0;  // multiply-accumulates per run
};
[[nodiscard]] LayerCost layer_cost(const formats::LayerRecord& layer, const Shape& input,
                                   const Shape& output);

}  // namespace mien::engine
