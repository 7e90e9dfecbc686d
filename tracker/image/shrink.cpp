// Downscales images by area averaging.
#include "tracker/image/shrink.h"

#include <algorithm>

namespace mien::tracker {
namespace {

// The pixels that one pixel of the smaller image covers along one axis: fractions of the pixels
// `first` and `last`, and all pixels between them.
struct Coverage {
  Coverage(std::int32_t index, float pixels, std::int32_t end) {
    const float low = static_cast<float>(index) * pixels, high = low + pixels;
    first = static_cast<std::int32_t>(low);
    last = std::min(static_cast<std::int32_t>(high), end - 1);
    first_fraction = std::min(high, static_cast<float>(first) + 1.0f) - low;
    last_fraction = last > first ? std::min(high - static_cast<float>(last), 1.0f) : 0.0f;
  }

  std::int32_t first;
  std::int32_t last;
  float first_fraction;
  float last_fraction;
};

void add(std::span<const float> values, float weight, std::span<float> sums) {
  std::transform(values.begin(), values.end(), sums.begin(), sums.begin(),
                 [weight](float value, float sum) { return sum + weight * value; });
}

// Sums the covered rows of `image`, of `line` floats each.
void sum_rows(std::span<const float> image, std::size_t line, const Coverage& rows,
              std::span<float> sums) {
  const auto row = [&](std::int32_t y) {
    return image.subspan(static_cast<std::size_t>(y) * line, line);
  };
  std::fill(sums.begin(), sums.end(), 0.0f);
  add(row(rows.first), rows.first_fraction, sums);
  for (std::int32_t y = rows.first + 1; y < rows.last; ++y) {
    add(row(y), 1.0f, sums);
  }
  add(row(rows.last), rows.last_fraction, sums);
}

// Sums the covered pixels of one row and scales them by `scale`. Returns the position of the next
// pixel.
float* sum_columns(const float* row, const Coverage& columns, float scale, float* out) {
  for (std::int32_t c = 0; c < 3; ++c) {
    float sum = columns.first_fraction * row[3 * columns.first + c];
    for (std::int32_t x = columns.first + 1; x < columns.last; ++x) {
      sum += row[3 * x + c];
    }
    *out++ = scale * (sum + columns.last_fraction * row[3 * columns.last + c]);
  }
  return out;
}

}  // namespace

void shrink(std::span<const float> image, std::int32_t from, std::span<float> smaller,
            std::int32_t to, std::span<float> scratch) {
  const float pixels = static_cast<float>(from) / static_cast<float>(to);
  const float scale = 1.0f / (pixels * pixels);
  const std::size_t line = 3 * static_cast<std::size_t>(from);
  const std::span<float> row = scratch.first(line);
  float* out = smaller.data();
  for (std::int32_t i = 0; i < to; ++i) {
    sum_rows(image, line, Coverage(i, pixels, from), row);
    for (std::int32_t j = 0; j < to; ++j) {
      out = sum_columns(row.data(), Coverage(j, pixels, from), scale, out);
    }
  }
}

}  // namespace mien::tracker
