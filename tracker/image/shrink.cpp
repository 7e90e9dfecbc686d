#include "tracker/image/shrink.h"

#include <algorithm>

namespace mien::tracker {
namespace {

// What one pixel of the smaller picture covers along one axis: parts of the pixels `first` and
// `last`, and all that lie between.
struct Cover {
  Cover(std::int32_t index, float pixels, std::int32_t end) {
    const float low = static_cast<float>(index) * pixels, high = low + pixels;
    first = static_cast<std::int32_t>(low);
    last = std::min(static_cast<std::int32_t>(high), end - 1);
    of_first = std::min(high, static_cast<float>(first) + 1.0f) - low;
    of_last = last > first ? std::min(high - static_cast<float>(last), 1.0f) : 0.0f;
  }

  std::int32_t first;
  std::int32_t last;
  float of_first;
  float of_last;
};

void add(std::span<const float> values, float weight, std::span<float> sums) {
  std::transform(values.begin(), values.end(), sums.begin(), sums.begin(),
                 [weight](float value, float sum) { return sum + weight * value; });
}

// Adds up the rows of `picture`, of `line` floats each, that are covered.
void sum_rows(std::span<const float> picture, std::size_t line, const Cover& rows,
              std::span<float> sums) {
  const auto row = [&](std::int32_t y) {
    return picture.subspan(static_cast<std::size_t>(y) * line, line);
  };
  std::fill(sums.begin(), sums.end(), 0.0f);
  add(row(rows.first), rows.of_first, sums);
  for (std::int32_t y = rows.first + 1; y < rows.last; ++y) {
    add(row(y), 1.0f, sums);
  }
  add(row(rows.last), rows.of_last, sums);
}

// The same of the pixels of one row, times `scale`; returns where the next pixel goes.
float* sum_columns(const float* row, const Cover& columns, float scale, float* out) {
  for (std::int32_t c = 0; c < 3; ++c) {
    float sum = columns.of_first * row[3 * columns.first + c];
    for (std::int32_t x = columns.first + 1; x < columns.last; ++x) {
      sum += row[3 * x + c];
    }
    *out++ = scale * (sum + columns.of_last * row[3 * columns.last + c]);
  }
  return out;
}

}  // namespace

void shrink(std::span<const float> picture, std::int32_t from, std::span<float> smaller,
            std::int32_t to, std::span<float> scratch) {
  const float pixels = static_cast<float>(from) / static_cast<float>(to);
  const float scale = 1.0f / (pixels * pixels);
  const std::size_t line = 3 * static_cast<std::size_t>(from);
  const std::span<float> row = scratch.first(line);
  float* out = smaller.data();
  for (std::int32_t i = 0; i < to; ++i) {
    sum_rows(picture, line, Cover(i, pixels, from), row);
    for (std::int32_t j = 0; j < to; ++j) {
      out = sum_columns(row.data(), Cover(j, pixels, from), scale, out);
    }
  }
}

}  // namespace mien::tracker
