// Shapes of feature maps, and of what a layer makes of them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/status.h"
#include "formats/mien_format.h"

namespace mien::engine {

struct Shape {
  std::int32_t h = 0, w = 0, c = 0;

  friend bool operator==(const Shape&, const Shape&) = default;
  // A camera crop: few channels, stored [h][w][c]. Everything else is in blocks of 8 channels.
  [[nodiscard]] bool interleaved() const { return c <= 4 && (h > 1 || w > 1); }
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(h) * static_cast<std::size_t>(w);
  }
};

// Floats of a map in blocks, unused lanes included.
[[nodiscard]] inline std::size_t blocked_elems(const Shape& shape) {
  return shape.pixels() * ((static_cast<std::size_t>(shape.c) + 7) / 8 * 8);
}

// Whether the map, blocked, is within formats::kMaxMapElems, as those that a file declares are.
[[nodiscard]] bool is_allowed(const Shape& shape);

// Output shape of a layer. `second` is the second input of an addition or
// concatenation. kShapeMismatch when the
// input does not suit the operation.
Status infer_shape(const formats::LayerRecord& layer, const Shape& input, const Shape& second,
                   Shape& output);

// Of the layer by itself: channels as declared, not as padded.
struct LayerCost {
  std::uint64_t parameters = 0;
  std::uint64_t macs = 0;  // multiply-accumulates of one run
};
[[nodiscard]] LayerCost layer_cost(const formats::LayerRecord& layer, const Shape& input,
                                   const Shape& output);

}  // namespace mien::engine
