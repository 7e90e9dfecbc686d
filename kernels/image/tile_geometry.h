// The parts of the image that the warp of tiers with SIMD reads: channels, tiles of the output, and
// the windows of a channel that tiles need.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/image/warp.h"

namespace mien::kernels::tiles {
namespace {

// A channel of the image: its plane and the mapping from output to boxes.
struct Channel {
  Plane plane;
  std::int32_t width, height;  // samples of the plane
  std::int32_t box;
  // Position in boxes of output (row i, column j):
  //   x = across[0] (j + 0.5) + across[1] (i + 0.5) + across[2], y = down[0] (j + 0.5) + ...
  float across[3], down[3];
  // Positions more than two boxes beyond the border are equivalent.
  float end_x, end_y;

  Channel() = default;
  Channel(const Plane& of, std::int32_t columns, std::int32_t rows, std::int32_t size,
          float samples_per_pixel, const float matrix[6])
      : plane(of), width(columns), height(rows), box(size) {
    const auto side = static_cast<float>(size);
    for (std::int32_t k = 0; k < 3; ++k) {
      across[k] = matrix[k] * (samples_per_pixel / side);
      down[k] = matrix[3 + k] * (samples_per_pixel / side);
    }
    end_x = static_cast<float>(columns) / side + 2.0f;
    end_y = static_cast<float>(rows) / side + 2.0f;
  }

  [[nodiscard]] bool has_grid_of(const Channel& other) const {
    return std::equal(across, across + 3, other.across) && std::equal(down, down + 3, other.down) &&
           end_x == other.end_x && end_y == other.end_y;
  }
};

// A rectangle of outputs, ends excluded.
struct Tile {
  std::int32_t top, bottom, left, right;

  [[nodiscard]] bool is_one() const { return bottom - top == 1 && right - left == 1; }
  [[nodiscard]] bool is_wide() const { return right - left > bottom - top; }
  [[nodiscard]] std::int32_t centre() const {
    return is_wide() ? (left + right) / 2 : (top + bottom) / 2;
  }
  [[nodiscard]] Tile first_half() const {
    return is_wide() ? Tile{top, bottom, left, centre()} : Tile{top, centre(), left, right};
  }
  [[nodiscard]] Tile second_half() const {
    return is_wide() ? Tile{top, bottom, centre(), right} : Tile{centre(), bottom, left, right};
  }
};

// A rectangle of boxes of a channel.
struct Window {
  std::int32_t left = 0, top = 0, columns = 0, rows = 0;

  Window() = default;
  // Ends included; a bilinear sample also needs the next box.
  Window(std::int32_t from_x, std::int32_t to_x, std::int32_t from_y, std::int32_t to_y)
      : left(from_x), top(from_y), columns(to_x - from_x + 2), rows(to_y - from_y + 2) {}

  [[nodiscard]] std::int32_t samples() const { return rows * columns; }
};
}  // namespace
}  // namespace mien::kernels::tiles
