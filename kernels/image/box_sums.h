// Copies of a window of the image for the warp of tiers with SIMD: sums of boxes, 16 bits each,
// with the border repeated. See tiles.h for the members of `Simd`.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/image/tile_geometry.h"

namespace mien::kernels::tiles {

constexpr std::int32_t kMaxSums = 832;  // samples of an image row before the boxes are summed
constexpr std::int32_t kMaxBox = 8;
constexpr std::int32_t kRowsAhead = 16;  // distance to rows of the image that are prefetched
constexpr std::int32_t kPadding = 64;    // samples that vectors may write beyond the end

namespace {

template <class Simd>
class BoxSums {
 public:
  // Writes the copy row by row. Vectors may write beyond a row, which the next row then overwrites.
  // `shares_bytes`: another channel already read the bytes between this one's.
  void fill(const Channel& channel, const Window& window, bool shares_bytes,
            std::uint16_t* samples) {
    const std::int32_t count = window.columns * channel.box;
    const std::int32_t begin = window.left * channel.box;
    const std::int32_t first = std::clamp(begin, 0, channel.width - 1);
    const std::int32_t last = std::clamp(begin + count - 1, 0, channel.width - 1);
    const bool inside = last - first + 1 == count;
    for (std::int32_t r = 0; r < window.rows; ++r) {
      const std::int32_t top = (window.top + r) * channel.box;
      const Rows rows = rows_of(channel, top, first);
      if (!shares_bytes) {
        prefetch(channel, rows_of(channel, top + kRowsAhead, first), last - first);
      }
      std::uint16_t* row = samples + std::ptrdiff_t{r} * window.columns;
      const auto buffer = [&](std::int32_t n) { return n == window.columns ? row : sums_; };
      std::int32_t n = count;
      if (inside && channel.box > 1 && channel.plane.pixel_bytes == 1) {
        n /= 2;
        sum_rows<2>(rows.at, channel.box, n, count, buffer(n), BytePairs());
      } else {
        sum_columns(rows.at, channel, last - first + 1, inside ? buffer(n) : sums_);
        if (!inside) {
          repeat_border(std::clamp(first - begin, 0, count - 1), last - first + 1, count,
                        buffer(n));
        }
      }
      while (n > window.columns) {
        n /= 2;
        halve(n, buffer(n), [](auto a, auto b) { return Simd::pairs(a, b); });
      }
    }
  }

 private:
  struct Rows {
    const std::uint8_t* at[kMaxBox];
  };

  // The image rows of a row of boxes, from column `first` on.
  [[nodiscard]] static Rows rows_of(const Channel& channel, std::int32_t top, std::int32_t first) {
    Rows rows{};
    for (std::int32_t i = 0; i < channel.box; ++i) {
      rows.at[i] = channel.plane.data +
                   std::clamp(top + i, 0, channel.height - 1) * channel.plane.row_bytes +
                   first * channel.plane.pixel_bytes;
    }
    return rows;
  }

  // Requests rows that this tile or the next one reads soon: crops are narrow, so that CPUs do not
  // recognize the sequence of addresses.
  static void prefetch(const Channel& channel, const Rows& rows, std::ptrdiff_t columns) {
    constexpr std::ptrdiff_t kCacheLine = 64;
    const std::ptrdiff_t last = columns * channel.plane.pixel_bytes;
    for (std::int32_t i = 0; i < channel.box; ++i) {
      for (std::ptrdiff_t byte = 0; byte < last; byte += kCacheLine) {
        __builtin_prefetch(rows.at[i] + byte);
      }
      __builtin_prefetch(rows.at[i] + last);
    }
  }

  // Ways to read samples from a row of bytes: kSums at a time, or one.
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

  // Sums each of `columns` columns over the rows of a box.
  void sum_columns(const std::uint8_t* const* rows, const Channel& channel, std::int32_t columns,
                   std::uint16_t* sums) {
    constexpr std::ptrdiff_t kMaxNear = 4;
    if (channel.plane.pixel_bytes > kMaxNear) {  // byte offsets in a row may exceed 32 bits
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

  // n sums over `count` rows of samples kBytes apart. Reads at most `bytes` bytes of a row.
  template <std::int32_t kBytes, class Reader>
  static void sum_rows(const std::uint8_t* const* rows, std::int32_t count, std::int32_t n,
                       std::int32_t bytes, std::uint16_t* sums, Reader reader) {
    const auto sum = [&](std::int32_t i) {
      auto total = reader.several(rows[0] + kBytes * i);
      for (std::int32_t row = 1; row < count; ++row) {
        total = Simd::add_sums(total, reader.several(rows[row] + kBytes * i));
      }
      Simd::store_sums(sums + i, total);
    };
    const std::int32_t last = bytes / kBytes - Simd::kSums;  // last index with kSums samples
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
        total += reader.one(rows[row] + kBytes * i);
      }
      sums[i] = static_cast<std::uint16_t>(total);
    }
  }

  // Combines pairs of sums_ into n sums.
  template <class Combine>
  void halve(std::int32_t n, std::uint16_t* to, Combine of) {
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

  // Moves the first `inside` sums behind `left` copies of the first and fills up with the last.
  void repeat_border(std::int32_t left, std::int32_t inside, std::int32_t count,
                     std::uint16_t* to) const {
    const std::uint16_t first = sums_[0], last = sums_[inside - 1];
    std::copy_backward(sums_, sums_ + inside, to + left + inside);
    std::fill_n(to, left, first);
    std::fill(to + left + inside, to + std::max(count, left + inside), last);
  }

  alignas(64) std::uint16_t sums_[kMaxSums + kPadding];
};

}  // namespace
}  // namespace mien::kernels::tiles
