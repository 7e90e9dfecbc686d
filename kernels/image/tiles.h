// The warp of tiers with SIMD, tile by tile. For each tile it copies the needed part of the image
// as sums of boxes, 16 bits each, with the border repeated, so that two neighbours are one 32-bit
// load that is always in bounds. All code has internal linkage: the linker cannot merge code of
// different tiers.
//
// A tier supplies `Simd`, with vectors of kLanes floats and integers:
//   Vec, Ints; splat, load, count_from(first), fma(sum, a, b), sub, min, max, floor
//   finite_or_0(Vec); equal(Vec, Vec): 0 if different; to_ints(Vec); store(std::int32_t*, Ints)
//   Weights; weights_of(Vec): the interpolation weights of two neighbours, in units of 1 / kOne
//   Neighbours(column, row, stride, across, reach): the four neighbours of positions in a copy with
//     `stride` samples per row; rows_of<kCount>(copies): interpolates the upper and the lower row
//   Neighbours::Reach(x, y): of positions this far apart from lane to lane; rows_beyond: rows of a
//     copy that may be read below the neighbours
//   store_rgb(float*, Vec red, Vec green, Vec blue): kLanes pixels, interleaved
// and with vectors of kSums 16-bit integers:
//   Sums; load_sums, store_sums, add_sums
//   bytes(at): at[i]; byte_pairs(at): at[2 i] + at[2 i + 1]; even_bytes(at): at[2 i]
//   pairs(a, b), evens(a, b): the same for the integers in a and b, each below 2^15
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/image/box_sums.h"
#include "kernels/image/colour_transform.h"
#include "kernels/image/tile_geometry.h"
#include "kernels/image/warp.h"

namespace mien::kernels::tiles {

// Size of a tile of the output: wide, because each row of a copy has a fixed cost. A tile whose
// part of the image exceeds the buffers is halved.
constexpr std::int32_t kTileRows = 24, kTileColumns = 112;
constexpr std::int32_t kRowVecs = 5;      // vectors of a row computed together
constexpr std::int32_t kMaxPending = 13;  // parts of a tile: one per halving
constexpr std::int32_t kMaxStep = 3;      // samples per pixel when rows are summed
constexpr std::int32_t kMaxSamples = kWarpSampleElems - 3 * kPadding;  // of all channels' copies

namespace {

// `Neighbours` for tiers that gather each pair of samples:
//   gather(const std::uint16_t* base, Ints index, Weights)
template <class Simd>
class Gathered {
 public:
  using Vec = typename Simd::Vec;

  struct Reach {
    static constexpr std::int32_t rows_beyond = 0;
    Reach() = default;
    Reach(float, float) {}
  };

  Gathered() = default;
  Gathered(Vec column, Vec row, std::int32_t stride, Vec across, Reach)
      : index_(Simd::to_ints(Simd::fma(column, row, Simd::splat(static_cast<float>(stride))))),
        weights_(Simd::weights_of(across)),
        stride_(stride) {}

  template <int kCount>
  void rows_of(const std::uint16_t* const* copies, Vec* upper, Vec* lower) const {
    for (int c = 0; c < kCount; ++c) {
      upper[c] = Simd::gather(copies[c], index_, weights_);
      lower[c] = Simd::gather(copies[c] + stride_, index_, weights_);
    }
  }

 private:
  typename Simd::Ints index_;
  typename Simd::Weights weights_;
  std::int32_t stride_;
};

template <class Simd>
class Warp {
 public:
  explicit Warp(const WarpArgs& args) : a_(args) {
    set_channels();
    set_colours(colour_transform(args));
    for (std::int32_t c = 0; c < count_; ++c) {
      reach_[c] = {channels_[c].across[0], channels_[c].down[0]};
    }
  }

  void run() {
    for (std::int32_t i = 0; i < a_.height; i += kTileRows) {
      for (std::int32_t j = 0; j < a_.width; j += kTileColumns) {
        warp_tile({i, std::min(i + kTileRows, a_.height), j, std::min(j + kTileColumns, a_.width)});
      }
    }
  }

 private:
  using Vec = typename Simd::Vec;

  void set_channels() {
    const auto packed = [this](std::int32_t first) {
      Plane plane = a_.plane[0];
      plane.data += first;
      return Channel(plane, a_.image_width, a_.image_height, a_.box, 1.0f, a_.matrix);
    };
    const auto chroma = [this](std::int32_t index) {
      return Channel(a_.plane[index], (a_.image_width + 1) / 2, (a_.image_height + 1) / 2,
                     a_.chroma_box, 0.5f, a_.matrix);
    };
    switch (a_.format) {
      case PixelFormat::kGray8:
        count_ = 1;
        channels_[0] = packed(0);
        return;
      case PixelFormat::kYuv420:
        channels_[0] = packed(0), channels_[1] = chroma(1), channels_[2] = chroma(2);
        has_own_grid_ = !channels_[1].has_grid_of(channels_[0]);
        return;
      case PixelFormat::kRgb:
      case PixelFormat::kRgba:
        channels_[0] = packed(0), channels_[1] = packed(1), channels_[2] = packed(2);
        return;
      case PixelFormat::kBgr:
      case PixelFormat::kBgra:
        channels_[0] = packed(2), channels_[1] = packed(1), channels_[2] = packed(0);
        return;
    }
  }

  void set_colours(const ColourTransform& transform) {
    low_ = Simd::splat(transform.low), high_ = Simd::splat(transform.high);
    for (std::int32_t c = 0; c < 3; ++c) {
      for (std::int32_t k = 0; k < 4; ++k) {
        weights_[c][k] = Simd::splat(transform.weights[c][k]);
      }
    }
  }

  // A position in boxes.
  struct Point {
    Vec x, y;
  };

  // The outputs of one row, for one channel.
  struct Line {
    Vec x, y, step_x, step_y;
  };

  // The box up and left of a position, and the fractions to the next box.
  struct Position {
    Vec column, row, across, down;
  };

  [[nodiscard]] static Line line(const Channel& channel, std::int32_t i) {
    const Vec row = Simd::splat(static_cast<float>(i) + 0.5f);
    const auto start = [&](const float* m) {
      return Simd::fma(Simd::splat(m[2]), row, Simd::splat(m[1]));
    };
    return {start(channel.across), start(channel.down), Simd::splat(channel.across[0]),
            Simd::splat(channel.down[0])};
  }

  // `centres`: columns of pixel centres.
  [[nodiscard]] static Point point(const Line& line, Vec centres) {
    return {Simd::fma(line.x, centres, line.step_x), Simd::fma(line.y, centres, line.step_y)};
  }

  [[nodiscard]] static Position position(const Point& point, const Channel& channel) {
    const auto within = [](Vec coordinate, float end) {
      const Vec clamped = Simd::min(Simd::max(coordinate, Simd::splat(-2.0f)), Simd::splat(end));
      return Simd::sub(clamped, Simd::splat(0.5f));
    };
    const Vec x = within(point.x, channel.end_x), y = within(point.y, channel.end_y);
    const Vec column = Simd::floor(x), row = Simd::floor(y);
    return {column, row, Simd::sub(x, column), Simd::sub(y, row)};
  }

  // Warps a tile, split into parts if its part of the image exceeds the buffers.
  void warp_tile(const Tile& tile) {
    Tile pending[kMaxPending] = {tile};
    for (std::int32_t count = 1; count > 0;) {
      const Tile part = pending[--count];
      if (copy(part)) {
        warp_copied(part);
      } else {
        pending[count++] = part.second_half();
        pending[count++] = part.first_half();
      }
    }
  }

  void warp_copied(const Tile& tile) {
    if (a_.format == PixelFormat::kGray8) {
      warp_rows(tile, [this](const Spots& at, Vec rgb[3]) { gray(at, rgb); });
    } else if (has_chroma()) {
      warp_rows(tile, [this](const Spots& at, Vec rgb[3]) { from_yuv(at, rgb); });
    } else {
      warp_rows(tile, [this](const Spots& at, Vec rgb[3]) { from_packed(at, rgb); });
    }
  }

  // Copies the part of the image that the tile needs; returns false if it exceeds the buffers.
  [[nodiscard]] bool copy(const Tile& tile) {
    for (std::int32_t c = 0; c < count_; ++c) {
      // The third channel has the grid of the second, which usually has that of the first.
      if (c == 2 || (c == 1 && !has_own_grid_)) {
        windows_[c] = windows_[c - 1];
        continue;
      }
      Point upper = corners(channels_[c], tile, tile.top);
      Point lower = corners(channels_[c], tile, tile.bottom - 1);
      if (tile.is_one()) {
        upper = lower = finite(upper);
      } else if (!all_finite(upper) || !all_finite(lower)) {
        return false;  // between finite corners all positions are finite and ordered
      }
      windows_[c] = window(position(upper, channels_[c]), position(lower, channels_[c]));
    }
    if (!lay_out()) {
      return false;
    }
    for (std::int32_t c = 0; c < count_; ++c) {
      const bool shares_bytes = c > (has_chroma() ? 1 : 0) && channels_[c].plane.pixel_bytes > 1;
      sums_.fill(channels_[c], windows_[c], shares_bytes, copies_[c]);
    }
    return true;
  }

  // Assigns buffers to the copies. Coordinates are below 2^16, so that products do not overflow.
  [[nodiscard]] bool lay_out() {
    std::int32_t used = 0;
    for (std::int32_t c = 0; c < count_; ++c) {
      const Window& window = windows_[c];
      const Channel& channel = channels_[c];
      const auto step = std::min<std::int64_t>(channel.plane.pixel_bytes, kMaxStep);
      if (window.columns > kMaxSums || window.rows > kMaxSamples ||
          window.columns * channel.box * step > kMaxSums ||
          used + window.samples() + reach_[c].rows_beyond * window.columns > kMaxSamples) {
        return false;
      }
      copies_[c] = a_.samples + used + c * kPadding;
      used += window.samples();
    }
    return true;
  }

  [[nodiscard]] bool has_chroma() const { return a_.format == PixelFormat::kYuv420; }

  // Positions of the left and right end of a row of the tile, in the first two lanes.
  [[nodiscard]] static Point corners(const Channel& channel, const Tile& tile, std::int32_t i) {
    float centres[Simd::kLanes];
    std::fill_n(centres, Simd::kLanes, static_cast<float>(tile.right) - 0.5f);
    centres[0] = static_cast<float>(tile.left) + 0.5f;
    return point(line(channel, i), Simd::load(centres));
  }

  [[nodiscard]] static Point finite(const Point& at) {
    return {Simd::finite_or_0(at.x), Simd::finite_or_0(at.y)};
  }

  [[nodiscard]] static bool all_finite(const Point& at) {
    std::int32_t unchanged[2][Simd::kLanes];
    // finite() changes values that are not finite.
    const Point finite_at = finite(at);
    Simd::store(unchanged[0], Simd::equal(at.x, finite_at.x));
    Simd::store(unchanged[1], Simd::equal(at.y, finite_at.y));
    return (unchanged[0][0] & unchanged[0][1] & unchanged[1][0] & unchanged[1][1]) != 0;
  }

  [[nodiscard]] static Window window(const Position& upper, const Position& lower) {
    std::int32_t columns[2][Simd::kLanes], rows[2][Simd::kLanes];
    Simd::store(columns[0], Simd::to_ints(upper.column));
    Simd::store(columns[1], Simd::to_ints(lower.column));
    Simd::store(rows[0], Simd::to_ints(upper.row));
    Simd::store(rows[1], Simd::to_ints(lower.row));
    const auto x = std::minmax({columns[0][0], columns[0][1], columns[1][0], columns[1][1]});
    const auto y = std::minmax({rows[0][0], rows[0][1], rows[1][0], rows[1][1]});
    return Window(x.first, x.second, y.first, y.second);
  }

  // A position in a copy, with its neighbours and the fraction to the lower row.
  struct Spot {
    typename Simd::Neighbours neighbours;
    Vec down;
  };

  // The positions in the grids of the first channel and of chroma.
  struct Spots {
    Spot first, chroma;
  };

  // `colour(spots, rgb)` computes the colours. Positions of several vectors come first, because one
  // vector's position and colour form a dependency chain too long for out-of-order execution.
  template <class Colour>
  void warp_rows(const Tile& tile, Colour colour) {
    constexpr std::int32_t kColumns = kRowVecs * Simd::kLanes;
    Spots spots[kRowVecs];
    for (std::int32_t i = tile.top; i < tile.bottom; ++i) {
      for (std::int32_t left = tile.left; left < tile.right; left += kColumns) {
        const std::int32_t right = std::min(left + kColumns, tile.right);
        find(tile, i, left, right, spots);
        const Spots* at = spots;
        float* y = a_.y + std::ptrdiff_t{i} * a_.width * 3;
        for (std::int32_t next = left; next < right; next += Simd::kLanes) {
          const std::int32_t j = column(tile, next);
          Vec rgb[3];
          colour(*at++, rgb);
          store(rgb, y + std::ptrdiff_t{3} * j, tile.right - j);
        }
      }
    }
  }

  // The last vector of a row overlaps the previous one.
  [[nodiscard]] static std::int32_t column(const Tile& tile, std::int32_t next) {
    return std::max(std::min(next, tile.right - Simd::kLanes), tile.left);
  }

  void find(const Tile& tile, std::int32_t i, std::int32_t left, std::int32_t right,
            Spots* spots) const {
    const Line first = line(channels_[0], i), chroma = line(channels_[1], i);
    for (std::int32_t next = left; next < right; next += Simd::kLanes) {
      const auto j = static_cast<float>(column(tile, next));
      const Vec centres =
          Simd::min(Simd::count_from(j + 0.5f), Simd::splat(static_cast<float>(tile.right) - 0.5f));
      const auto at = [&](const Line& line) {
        const Point centre = point(line, centres);
        return tile.is_one() ? finite(centre) : centre;
      };
      find(at(first), 0, spots->first);
      if (has_own_grid_) {
        find(at(chroma), 1, spots->chroma);
      }
      ++spots;
    }
  }

  void find(const Point& point, std::int32_t c, Spot& spot) const {
    const Position at = position(point, channels_[c]);
    const Window& window = windows_[c];
    const auto from = [](Vec coordinate, std::int32_t first) {
      return Simd::sub(coordinate, Simd::splat(static_cast<float>(first)));
    };
    spot.neighbours = {from(at.column, window.left), from(at.row, window.top), window.columns,
                       at.across, reach_[c]};
    spot.down = at.down;
  }

  // Stores up to `left` pixels.
  static void store(const Vec rgb[3], float* y, std::int32_t left) {
    if (left >= Simd::kLanes) {
      return Simd::store_rgb(y, rgb[0], rgb[1], rgb[2]);
    }
    float pixels[3 * Simd::kLanes];
    Simd::store_rgb(pixels, rgb[0], rgb[1], rgb[2]);
    std::copy_n(pixels, 3 * left, y);
  }

  void gray(const Spots& at, Vec rgb[3]) const {
    Vec y;
    sample<1>(at.first, 0, &y);
    rgb[0] = rgb[1] = rgb[2] = clamped(weighted(0, 0, y, shift(0)));
  }

  void from_yuv(const Spots& at, Vec rgb[3]) const {
    Vec yuv[3];
    if (has_own_grid_) {
      sample<1>(at.first, 0, yuv);
      sample<2>(at.chroma, 1, yuv + 1);
    } else {
      sample<3>(at.first, 0, yuv);
    }
    const Vec y = yuv[0], u = yuv[1], v = yuv[2];
    rgb[0] = clamped(weighted(0, 2, v, weighted(0, 0, y, shift(0))));
    rgb[1] = clamped(weighted(1, 2, v, weighted(1, 1, u, weighted(1, 0, y, shift(1)))));
    rgb[2] = clamped(weighted(2, 1, u, weighted(2, 0, y, shift(2))));
  }

  void from_packed(const Spots& at, Vec rgb[3]) const {
    sample<3>(at.first, 0, rgb);
    for (std::int32_t c = 0; c < 3; ++c) {
      rgb[c] = weighted(c, c, rgb[c], shift(c));
    }
  }

  [[nodiscard]] Vec shift(std::int32_t c) const { return weights_[c][3]; }
  [[nodiscard]] Vec weighted(std::int32_t c, std::int32_t of, Vec sample, Vec sum) const {
    return Simd::fma(sum, sample, weights_[c][of]);
  }
  [[nodiscard]] Vec clamped(Vec value) const { return Simd::min(Simd::max(value, low_), high_); }

  // Bilinear samples of kCount channels from `first` on.
  template <int kCount>
  void sample(const Spot& spot, std::int32_t first, Vec* sums) const {
    Vec upper[kCount], lower[kCount];
    spot.neighbours.template rows_of<kCount>(copies_ + first, upper, lower);
    for (int c = 0; c < kCount; ++c) {
      sums[c] = Simd::fma(upper[c], spot.down, Simd::sub(lower[c], upper[c]));
    }
  }

  const WarpArgs& a_;
  Vec weights_[3][4], low_, high_;  // of the colour transform
  std::int32_t count_ = 3;
  bool has_own_grid_ = false;  // chroma has another grid than luma
  Channel channels_[3] = {};
  typename Simd::Neighbours::Reach reach_[3];
  Window windows_[3] = {};
  std::uint16_t* copies_[3] = {};
  BoxSums<Simd> sums_;
};

}  // namespace
}  // namespace mien::kernels::tiles
