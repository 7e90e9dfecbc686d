// The warp of tiers with vectors: tile by tile, each from a small copy of what it needs of the
// image. The copy is made of sums of boxes, 16 bits each, with the border repeated, so that two
// neighbours are one load of 32 bits that is always inside. Everything has internal linkage: no
// code of one tier may be merged with that of another.
//
// `Simd` is what a tier has: vectors of kLanes floats and integers,
//   Vec, Ints; splat, load, count_from(first), fma(sum, a, b), sub, min, max, floor
//   finite_or_0(Vec); equal(Vec, Vec): 0 where not; to_ints(Vec); store(std::int32_t*, Ints)
//   Shares; shares_of(Vec): of neighbours that a place lies between, in parts of kWhole
//   Neighbours(column, row, stride, across): where between numbers of a copy with so many in a row,
//     and above and below them; rows_of<kCount>(copies): of each copy the sum of a number's and the
//     next one's share, of the upper row and the lower
//   store_rgb(float*, Vec, Vec, Vec): kLanes pixels, interleaved
// and of kSums numbers of 16 bits,
//   Sums; load_sums, store_sums, add_sums
//   bytes(at): at[i]; byte_pairs(at): at[2 i] + at[2 i + 1]; even_bytes(at): at[2 i]
//   pairs(a, b), evens(a, b): the same of the numbers in a and b, each below 2^15
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/image/warp.h"

namespace mien::kernels::tiles {

// Of the output: wide, since each row of a copy costs something. A tile that needs more of the
// image than there is room for is halved.
constexpr std::int32_t kTileRows = 24, kTileColumns = 112;
constexpr std::int32_t kMaxSums = 832;    // of a row, before it is made smaller
constexpr std::int32_t kPiece = 5;        // vectors of a row at a time
constexpr std::int32_t kMaxWaiting = 13;  // parts of a tile: one for each time it is halved
constexpr std::int32_t kMaxBox = 8;
constexpr std::int32_t kMaxStep = 3;  // numbers from one pixel to the next when rows are summed
constexpr std::int32_t kSpare = 64;   // vectors may go on beyond what they are asked for
constexpr std::int32_t kMaxSamples = kWarpSampleElems - 3 * kSpare;  // of a copy of all channels
constexpr std::int32_t kWhole = 1 << 14;  // its products with sums of boxes fit into 32 bits

namespace {

// One number of a pixel: where it is, and how it is made smaller.
struct Channel {
  Plane plane;
  std::int32_t width, height;  // samples of the plane
  std::int32_t box;
  // Between which boxes output (row i, column j) lies:
  //   x = across[0] (j + 0.5) + across[1] (i + 0.5) + across[2], y = down[0] (j + 0.5) + ...
  float across[3], down[3];
  // Beyond the border by more than two boxes everything is the same.
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

// Of the outputs, ends excluded.
struct Tile {
  std::int32_t top, bottom, left, right;

  [[nodiscard]] bool is_one() const { return bottom - top == 1 && right - left == 1; }
  [[nodiscard]] bool is_wide() const { return right - left > bottom - top; }
  [[nodiscard]] std::int32_t middle() const {
    return is_wide() ? (left + right) / 2 : (top + bottom) / 2;
  }
  [[nodiscard]] Tile first_half() const {
    return is_wide() ? Tile{top, bottom, left, middle()} : Tile{top, middle(), left, right};
  }
  [[nodiscard]] Tile second_half() const {
    return is_wide() ? Tile{top, bottom, middle(), right} : Tile{middle(), bottom, left, right};
  }
};

// Of the boxes of a channel.
struct Window {
  std::int32_t left = 0, top = 0, columns = 0, rows = 0;

  Window() = default;
  // Ends included; a bilinear sample needs the next box too.
  Window(std::int32_t from_x, std::int32_t to_x, std::int32_t from_y, std::int32_t to_y)
      : left(from_x), top(from_y), columns(to_x - from_x + 2), rows(to_y - from_y + 2) {}

  [[nodiscard]] std::int32_t samples() const { return rows * columns; }
};

// Sums of boxes to what the network reads: rows of red, green and blue; the last number of a row is
// added. What comes out is kept between low and high.
struct Mixing {
  float weights[3][4];  // the sums come in parts of kWhole
  float low, high;
};

inline Mixing mixing_of(const WarpArgs& a) {
  const auto share = [](std::int32_t box) {
    return 1.0f / (static_cast<float>(box * box) * static_cast<float>(kWhole));
  };
  const bool has_luma = a.format == PixelFormat::kGray8 || a.format == PixelFormat::kYuv420;
  const bool half_input = has_luma && !a.full_range;
  const float contrast = half_input ? 255.0f / 219.0f : 1.0f;
  const float black = half_input ? -16.0f * contrast : 0.0f;
  const float of_first = contrast * share(a.box);
  const float colour = (half_input ? 255.0f / 224.0f : 1.0f);
  const auto number = [](double value) { return static_cast<float>(value); };
  const YuvMatrix& m = a.yuv_matrix;
  const float of_u[3] = {0.0f, number(m.green_of_u), number(m.blue_of_u)};
  const float of_v[3] = {number(m.red_of_v), number(m.green_of_v), 0.0f};
  Mixing mixing{};
  for (std::int32_t c = 0; c < 3; ++c) {
    float* w = mixing.weights[c];
    w[3] = black;
    if (a.format == PixelFormat::kYuv420) {
      w[0] = of_first;
      w[1] = of_u[c] * colour * share(a.chroma_box);
      w[2] = of_v[c] * colour * share(a.chroma_box);
      w[3] -= 128.0f * colour * (of_u[c] + of_v[c]);
    } else {
      w[has_luma ? 0 : c] = of_first;
    }
    for (std::int32_t k = 0; k < 4; ++k) {
      w[k] *= a.scale;
    }
    w[3] += a.offset;
  }
  const float ends[2] = {a.offset, 255.0f * a.scale + a.offset};
  mixing.low = std::min(ends[0], ends[1]);
  mixing.high = std::max(ends[0], ends[1]);
  return mixing;
}

// The Neighbours of tiers that gather each pair of numbers:
//   gather(const std::uint16_t* base, Ints index, Shares)
template <class Simd>
class Gathered {
 public:
  using Vec = typename Simd::Vec;

  Gathered() = default;
  Gathered(Vec column, Vec row, std::int32_t stride, Vec across)
      : index_(Simd::to_ints(Simd::fma(column, row, Simd::splat(static_cast<float>(stride))))),
        shares_(Simd::shares_of(across)),
        stride_(stride) {}

  template <int kCount>
  void rows_of(const std::uint16_t* const* copies, Vec* upper, Vec* lower) const {
    for (int c = 0; c < kCount; ++c) {
      upper[c] = Simd::gather(copies[c], index_, shares_);
      lower[c] = Simd::gather(copies[c] + stride_, index_, shares_);
    }
  }

 private:
  typename Simd::Ints index_;
  typename Simd::Shares shares_;
  std::int32_t stride_;
};

template <class Simd>
class Warp {
 public:
  explicit Warp(const WarpArgs& args) : a_(args), mixing_(mixing_of(args)) {
    const std::int32_t chroma_width = (args.image_width + 1) / 2;
    const std::int32_t chroma_height = (args.image_height + 1) / 2;
    const auto packed = [&](std::int32_t first) {
      Plane plane = args.plane[0];
      plane.data += first;
      return Channel(plane, args.image_width, args.image_height, args.box, 1.0f, args.matrix);
    };
    const auto chroma = [&](std::int32_t index) {
      return Channel(args.plane[index], chroma_width, chroma_height, args.chroma_box, 0.5f,
                     args.matrix);
    };
    switch (args.format) {
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

  void run() {
    for (std::int32_t i = 0; i < a_.height; i += kTileRows) {
      for (std::int32_t j = 0; j < a_.width; j += kTileColumns) {
        warp_tile({i, std::min(i + kTileRows, a_.height), j, std::min(j + kTileColumns, a_.width)});
      }
    }
  }

 private:
  using Vec = typename Simd::Vec;

  // In boxes.
  struct Place {
    Vec x, y;
  };

  // Outputs in one row, of a channel.
  struct Line {
    Vec x, y, step_x, step_y;
  };

  // Between which boxes, and where between them.
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

  // `middles`: of columns.
  [[nodiscard]] static Place place(const Line& line, Vec middles) {
    return {Simd::fma(line.x, middles, line.step_x), Simd::fma(line.y, middles, line.step_y)};
  }

  [[nodiscard]] static Position position(const Place& place, const Channel& channel) {
    const auto within = [](Vec coordinate, float end) {
      const Vec kept = Simd::min(Simd::max(coordinate, Simd::splat(-2.0f)), Simd::splat(end));
      return Simd::sub(kept, Simd::splat(0.5f));
    };
    const Vec x = within(place.x, channel.end_x), y = within(place.y, channel.end_y);
    const Vec column = Simd::floor(x), row = Simd::floor(y);
    return {column, row, Simd::sub(x, column), Simd::sub(y, row)};
  }

  // A tile, or part after part of it where it needs too much of the image.
  void warp_tile(const Tile& tile) {
    Tile waiting[kMaxWaiting] = {tile};
    for (std::int32_t count = 1; count > 0;) {
      const Tile part = waiting[--count];
      if (copy(part)) {
        warp_copied(part);
      } else {
        waiting[count++] = part.second_half();
        waiting[count++] = part.first_half();
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

  // False when the tile needs more of the image than there is room for.
  [[nodiscard]] bool copy(const Tile& tile) {
    for (std::int32_t c = 0; c < count_; ++c) {
      // The third channel lies where the second does, and most often that where the first does.
      if (c == 2 || (c == 1 && !has_own_grid_)) {
        windows_[c] = windows_[c - 1];
        continue;
      }
      Place upper = corners(channels_[c], tile, tile.top);
      Place lower = corners(channels_[c], tile, tile.bottom - 1);
      if (tile.is_one()) {
        upper = lower = finite(upper);
      } else if (!all_finite(upper) || !all_finite(lower)) {
        return false;  // between numbers that are finite all are, and in order
      }
      windows_[c] = window(position(upper, channels_[c]), position(lower, channels_[c]));
    }
    if (!lay_out()) {
      return false;
    }
    for (std::int32_t c = 0; c < count_; ++c) {
      fill(channels_[c], windows_[c], copies_[c]);
    }
    return true;
  }

  // Finds room for the copies. Coordinates are below 2^16, so that all products fit.
  [[nodiscard]] bool lay_out() {
    std::int32_t used = 0;
    for (std::int32_t c = 0; c < count_; ++c) {
      const Window& window = windows_[c];
      const Channel& channel = channels_[c];
      const auto step = std::min<std::int64_t>(channel.plane.pixel_bytes, kMaxStep);
      if (window.columns > kMaxSums || window.rows > kMaxSamples ||
          window.columns * channel.box * step > kMaxSums || used + window.samples() > kMaxSamples) {
        return false;
      }
      copies_[c] = a_.samples + used + c * kSpare;
      used += window.samples();
    }
    return true;
  }

  [[nodiscard]] bool has_chroma() const { return a_.format == PixelFormat::kYuv420; }

  // Left and right end of a row of the tile in the first two lanes.
  [[nodiscard]] static Place corners(const Channel& channel, const Tile& tile, std::int32_t i) {
    float middles[Simd::kLanes];
    std::fill_n(middles, Simd::kLanes, static_cast<float>(tile.right) - 0.5f);
    middles[0] = static_cast<float>(tile.left) + 0.5f;
    return place(line(channel, i), Simd::load(middles));
  }

  [[nodiscard]] static Place finite(const Place& at) {
    return {Simd::finite_or_0(at.x), Simd::finite_or_0(at.y)};
  }

  [[nodiscard]] static bool all_finite(const Place& at) {
    std::int32_t same[2][Simd::kLanes];
    // A number that is not finite differs from what becomes of it.
    const Place finite_at = finite(at);
    Simd::store(same[0], Simd::equal(at.x, finite_at.x));
    Simd::store(same[1], Simd::equal(at.y, finite_at.y));
    return (same[0][0] & same[0][1] & same[1][0] & same[1][1]) != 0;
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

  // Row by row of boxes. Vectors may write beyond a row: the next one comes after it.
  void fill(const Channel& channel, const Window& window, std::uint16_t* samples) {
    const std::int32_t count = window.columns * channel.box;
    const std::int32_t begin = window.left * channel.box;
    const std::int32_t first = std::clamp(begin, 0, channel.width - 1);
    const std::int32_t last = std::clamp(begin + count - 1, 0, channel.width - 1);
    const bool inside = last - first + 1 == count;
    for (std::int32_t r = 0; r < window.rows; ++r) {
      const Rows rows = rows_of(channel, (window.top + r) * channel.box, first);
      std::uint16_t* row = samples + std::ptrdiff_t{r} * window.columns;
      const auto room = [&](std::int32_t n) { return n == window.columns ? row : sums_; };
      std::int32_t n = count;
      if (inside && channel.box > 1 && channel.plane.pixel_bytes == 1) {
        n /= 2;
        sum_rows<2>(rows.at, channel.box, n, count, room(n), BytePairs());
      } else {
        sum_columns(rows.at, channel, last - first + 1, inside ? room(n) : sums_);
        if (!inside) {
          repeat_border(std::clamp(first - begin, 0, count - 1), last - first + 1, count, room(n));
        }
      }
      while (n > window.columns) {
        n /= 2;
        halve(n, room(n), [](auto a, auto b) { return Simd::pairs(a, b); });
      }
    }
  }

  struct Rows {
    const std::uint8_t* at[kMaxBox];
  };

  // Those of a row of boxes, from column `first` on.
  [[nodiscard]] static Rows rows_of(const Channel& channel, std::int32_t top, std::int32_t first) {
    Rows rows{};
    for (std::int32_t i = 0; i < channel.box; ++i) {
      rows.at[i] = channel.plane.data +
                   std::clamp(top + i, 0, channel.height - 1) * channel.plane.row_bytes +
                   first * channel.plane.pixel_bytes;
    }
    return rows;
  }

  // Kinds of numbers in a row of bytes: kSums of them at a time, or one.
  struct Bytes {
    static auto several(const std::uint8_t* at) { return Simd::bytes(at); }
    static std::int32_t one(const std::uint8_t* at) { return at[0]; }
  };
  struct EvenBytes {
    static auto several(const std::uint8_t* at) { return Simd::even_bytes(at); }
    static std::int32_t one(const std::uint8_t* at) { return at[0]; }
  };
  struct BytePairs {
    static auto several(const std::uint8_t* at) { return Simd::byte_pairs(at); }
    static std::int32_t one(const std::uint8_t* at) { return at[0] + at[1]; }
  };

  // Of as many columns, over the rows of a box.
  void sum_columns(const std::uint8_t* const* rows, const Channel& channel, std::int32_t columns,
                   std::uint16_t* sums) {
    constexpr std::ptrdiff_t kMaxNear = 4;
    if (channel.plane.pixel_bytes > kMaxNear) {  // a row may have more bytes than 32 bits can count
      return sum_far_columns(rows, channel, columns, sums);
    }
    const auto step = static_cast<std::int32_t>(channel.plane.pixel_bytes);
    const std::int32_t bytes = (columns - 1) * step + 1;
    switch (step) {
      case 1:
        return sum_rows<1>(rows, channel.box, columns, bytes, sums, Bytes());
      case 2:
        return sum_rows<2>(rows, channel.box, columns, bytes, sums, EvenBytes());
      case 3:
        sum_rows<1>(rows, channel.box, bytes, bytes, sums_, Bytes());
        for (std::int32_t j = 0; j < columns; ++j) {
          sums[j] = sums_[3 * j];
        }
        return;
      default:
        sum_rows<2>(rows, channel.box, 2 * columns - 1, bytes, sums_, EvenBytes());
        return halve(columns, sums, [](auto a, auto b) { return Simd::evens(a, b); });
    }
  }

  // n sums over `count` rows, of numbers that lie kBytes apart. No more than `bytes` of a row are
  // read.
  template <std::int32_t kBytes, class Numbers>
  static void sum_rows(const std::uint8_t* const* rows, std::int32_t count, std::int32_t n,
                       std::int32_t bytes, std::uint16_t* sums, Numbers numbers) {
    const auto sum = [&](std::int32_t i) {
      auto total = numbers.several(rows[0] + kBytes * i);
      for (std::int32_t row = 1; row < count; ++row) {
        total = Simd::add_sums(total, numbers.several(rows[row] + kBytes * i));
      }
      Simd::store_sums(sums + i, total);
    };
    const std::int32_t last = bytes / kBytes - Simd::kSums;  // where there are still so many
    std::int32_t i = 0;
    for (; i <= last; i += Simd::kSums) {
      sum(i);
    }
    if (last > 0 && i < n) {
      sum(last);
      i = last + Simd::kSums;
    }
    for (; i < n; ++i) {
      std::int32_t total = 0;
      for (std::int32_t row = 0; row < count; ++row) {
        total += numbers.one(rows[row] + kBytes * i);
      }
      sums[i] = static_cast<std::uint16_t>(total);
    }
  }

  // Makes n numbers of twice as many in sums_.
  template <class Of>
  void halve(std::int32_t n, std::uint16_t* to, Of of) {
    for (std::int32_t i = 0; i < n; i += Simd::kSums) {
      const std::uint16_t* both = sums_ + std::ptrdiff_t{2} * i;
      Simd::store_sums(to + i, of(Simd::load_sums(both), Simd::load_sums(both + Simd::kSums)));
    }
  }

  static void sum_far_columns(const std::uint8_t* const* rows, const Channel& channel,
                              std::int32_t columns, std::uint16_t* sums) {
    for (std::int32_t j = 0; j < columns; ++j) {
      std::int32_t total = 0;
      for (std::int32_t i = 0; i < channel.box; ++i) {
        total += rows[i][j * channel.plane.pixel_bytes];
      }
      sums[j] = static_cast<std::uint16_t>(total);
    }
  }

  // Puts the `inside` first sums behind `left` copies of the first, and fills up with the last.
  void repeat_border(std::int32_t left, std::int32_t inside, std::int32_t count,
                     std::uint16_t* to) const {
    const std::uint16_t first = sums_[0], last = sums_[inside - 1];
    std::copy_backward(sums_, sums_ + inside, to + left + inside);
    std::fill_n(to, left, first);
    std::fill(to + left + inside, to + std::max(count, left + inside), last);
  }

  // Where in a copy, and where between there and its neighbours.
  struct Spot {
    typename Simd::Neighbours neighbours;
    Vec down;
  };

  // Of the first channel, and of those of another grid.
  struct Spots {
    Spot first, chroma;
  };

  // `colour(spots, rgb)` tells what is there. The places of several vectors come first: one after
  // the other they and the colours are a chain of instructions too long for a CPU to begin the
  // next.
  template <class Colour>
  void warp_rows(const Tile& tile, Colour colour) {
    constexpr std::int32_t kColumns = kPiece * Simd::kLanes;
    Spots spots[kPiece];
    for (std::int32_t i = tile.top; i < tile.bottom; ++i) {
      for (std::int32_t left = tile.left; left < tile.right; left += kColumns) {
        const std::int32_t right = std::min(left + kColumns, tile.right);
        find(tile, i, left, right, spots);
        const Spots* at = spots;
        for (std::int32_t next = left; next < right; next += Simd::kLanes) {
          const std::int32_t j = column(tile, next);
          Vec rgb[3];
          colour(*at++, rgb);
          store(rgb, a_.y + (std::ptrdiff_t{i} * a_.width + j) * 3, tile.right - j);
        }
      }
    }
  }

  // The last vector of a row overlaps the one before.
  [[nodiscard]] static std::int32_t column(const Tile& tile, std::int32_t next) {
    return std::max(std::min(next, tile.right - Simd::kLanes), tile.left);
  }

  void find(const Tile& tile, std::int32_t i, std::int32_t left, std::int32_t right,
            Spots* spots) const {
    const Line first = line(channels_[0], i), chroma = line(channels_[1], i);
    for (std::int32_t next = left; next < right; next += Simd::kLanes) {
      const auto j = static_cast<float>(column(tile, next));
      const Vec middles =
          Simd::min(Simd::count_from(j + 0.5f), Simd::splat(static_cast<float>(tile.right) - 0.5f));
      const auto at = [&](const Line& line) {
        const Place middle = place(line, middles);
        return tile.is_one() ? finite(middle) : middle;
      };
      find(at(first), 0, spots->first);
      if (has_own_grid_) {
        find(at(chroma), 1, spots->chroma);
      }
      ++spots;
    }
  }

  void find(const Place& place, std::int32_t c, Spot& spot) const {
    const Position at = position(place, channels_[c]);
    const Window& window = windows_[c];
    const auto from = [](Vec coordinate, std::int32_t first) {
      return Simd::sub(coordinate, Simd::splat(static_cast<float>(first)));
    };
    spot.neighbours = {from(at.column, window.left), from(at.row, window.top), window.columns,
                       at.across};
    spot.down = at.down;
  }

  // As many pixels as are left of a row.
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
    rgb[0] = rgb[1] = rgb[2] = kept(mixed(0, 0, y, shift(0)));
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
    rgb[0] = kept(mixed(0, 2, v, mixed(0, 0, y, shift(0))));
    rgb[1] = kept(mixed(1, 2, v, mixed(1, 1, u, mixed(1, 0, y, shift(1)))));
    rgb[2] = kept(mixed(2, 1, u, mixed(2, 0, y, shift(2))));
  }

  void from_packed(const Spots& at, Vec rgb[3]) const {
    sample<3>(at.first, 0, rgb);
    for (std::int32_t c = 0; c < 3; ++c) {
      rgb[c] = mixed(c, c, rgb[c], shift(c));
    }
  }

  [[nodiscard]] Vec shift(std::int32_t c) const { return Simd::splat(mixing_.weights[c][3]); }
  [[nodiscard]] Vec mixed(std::int32_t c, std::int32_t of, Vec sample, Vec sum) const {
    return Simd::fma(sum, sample, Simd::splat(mixing_.weights[c][of]));
  }
  [[nodiscard]] Vec kept(Vec value) const {
    return Simd::min(Simd::max(value, Simd::splat(mixing_.low)), Simd::splat(mixing_.high));
  }

  // Sums of kCount channels from the first on, each bilinear between four.
  template <int kCount>
  void sample(const Spot& spot, std::int32_t first, Vec* sums) const {
    Vec upper[kCount], lower[kCount];
    spot.neighbours.template rows_of<kCount>(copies_ + first, upper, lower);
    for (int c = 0; c < kCount; ++c) {
      sums[c] = Simd::fma(upper[c], spot.down, Simd::sub(lower[c], upper[c]));
    }
  }

  const WarpArgs& a_;
  const Mixing mixing_;
  std::int32_t count_ = 3;
  bool has_own_grid_ = false;  // chroma
  Channel channels_[3] = {};
  Window windows_[3] = {};
  std::uint16_t* copies_[3] = {};
  alignas(64) std::uint16_t sums_[kMaxSums + kSpare];
};

}  // namespace
}  // namespace mien::kernels::tiles
