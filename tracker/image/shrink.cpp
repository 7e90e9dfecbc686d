#include "tracker/image/shrink.h"

#include <algorithm>
#include <array>

namespace mien::tracker {
namespace {

// What one pixel of the smaller picture covers along one axis.
class Cover {
 public:
  Cover(std::int32_t index, float pixels, std::int32_t end)
      : low_(static_cast<float>(index) * pixels),
        high_(low_ + pixels),
        first_(static_cast<std::int32_t>(low_)),
        last_(std::min(static_cast<std::int32_t>(high_), end - 1)) {}

  [[nodiscard]] std::int32_t first() const { return first_; }
  [[nodiscard]] std::int32_t last() const { return last_; }
  [[nodiscard]] float length(std::int32_t pixel) const {
    const auto at = static_cast<float>(pixel);
    return std::max(std::min(high_, at + 1.0f) - std::max(low_, at), 0.0f);
  }

 private:
  float low_;
  float high_;
  std::int32_t first_;
  std::int32_t last_;
};

using Rgb = std::array<float, 3>;

Rgb mean(std::span<const float> picture, std::int32_t side, const Cover& rows,
         const Cover& columns) {
  Rgb sum = {};
  float area = 0.0f;
  for (std::int32_t y = rows.first(); y <= rows.last(); ++y) {
    const float height = rows.length(y);
    const float* pixel = &picture[3 * static_cast<std::size_t>(y * side + columns.first())];
    for (std::int32_t x = columns.first(); x <= columns.last(); ++x, pixel += 3) {
      const float weight = height * columns.length(x);
      area += weight;
      for (std::size_t c = 0; c < sum.size(); ++c) {
        sum[c] += weight * pixel[c];
      }
    }
  }
  return {sum[0] / area, sum[1] / area, sum[2] / area};
}

}  // namespace

void shrink(std::span<const float> picture, std::int32_t from, std::span<float> smaller,
            std::int32_t to) {
  const float pixels = static_cast<float>(from) / static_cast<float>(to);
  float* out = smaller.data();
  for (std::int32_t i = 0; i < to; ++i) {
    const Cover rows(i, pixels, from);
    for (std::int32_t j = 0; j < to; ++j) {
      const Rgb rgb = mean(picture, from, rows, Cover(j, pixels, from));
      out = std::copy(rgb.begin(), rgb.end(), out);
    }
  }
}

}  // namespace mien::tracker
