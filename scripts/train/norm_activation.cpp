// Batch norm in training with the limits of the activation behind it, in two sweeps over the map
// forwards and two backwards. Maps are [pixels][channels], fp32, of at most kMostChannels. Sums are
// fp32 within a block of pixels, fp64 over the blocks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace {

constexpr std::size_t kMostChannels = 1024;
constexpr std::size_t kBlock = 256;  // pixels

template <typename T>
using PerChannel = std::array<T, kMostChannels>;

struct Map {
  std::size_t pixels, channels;
};

struct Limits {
  float low, high;
};

// Two sums per channel.
class Sums {
 public:
  explicit Sums(Map map) : map_(map) {}
  float* first() { return first_.data(); }
  float* second() { return second_.data(); }

  void end_pixel(std::size_t pixel) {
    if (pixel % kBlock != kBlock - 1 && pixel + 1 != map_.pixels) {
      return;
    }
    for (std::size_t c = 0; c < map_.channels; ++c) {
      totals_first[c] += first_[c];
      totals_second[c] += second_[c];
      first_[c] = second_[c] = 0.0f;
    }
  }

  PerChannel<double> totals_first = {}, totals_second = {};

 private:
  Map map_;
  PerChannel<float> first_ = {}, second_ = {};
};

// z = scale x + shift is the normalised map before its limits.
struct Line {
  Line(Map map, const float* weight, const float* bias, const float* mean, const float* inverse) {
    for (std::size_t c = 0; c < map.channels; ++c) {
      scale[c] = weight[c] * inverse[c];
      shift[c] = bias[c] - scale[c] * mean[c];
    }
  }
  PerChannel<float> scale, shift;
};

void find_moments(const float* x, Map map, float epsilon, float* mean, float* inverse) {
  Sums sums(map);
  float *values = sums.first(), *squares = sums.second();
  for (std::size_t p = 0; p < map.pixels; ++p, x += map.channels) {
    for (std::size_t c = 0; c < map.channels; ++c) {
      values[c] += x[c];
      squares[c] += x[c] * x[c];
    }
    sums.end_pixel(p);
  }
  const auto n = static_cast<double>(map.pixels);
  for (std::size_t c = 0; c < map.channels; ++c) {
    const double m = sums.totals_first[c] / n;
    const double variance = std::max(sums.totals_second[c] / n - m * m, 0.0);
    mean[c] = static_cast<float>(m);
    inverse[c] = static_cast<float>(1.0 / std::sqrt(variance + epsilon));
  }
}

float passed(float z, Limits limits, float gradient) {
  return z > limits.low && z < limits.high ? gradient : 0.0f;
}

}  // namespace

extern "C" {

// y = limited(weight (x - mean) inverse + bias), inverse = 1 / sqrt(variance + epsilon); mean and
// inverse come out too.
void norm_activation_forward(const float* x, std::size_t pixels, std::size_t channels,
                             float epsilon, const float* weight, const float* bias, float low,
                             float high, float* mean, float* inverse, float* y) {
  find_moments(x, {pixels, channels}, epsilon, mean, inverse);
  const Line line({pixels, channels}, weight, bias, mean, inverse);
  for (std::size_t p = 0; p < pixels; ++p, x += channels, y += channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      y[c] = std::min(std::max(x[c] * line.scale[c] + line.shift[c], low), high);
    }
  }
}

// The gradients by x, weight and bias, from that by y.
void norm_activation_backward(const float* dy, const float* x, std::size_t pixels,
                              std::size_t channels, const float* weight, const float* bias,
                              float low, float high, const float* mean, const float* inverse,
                              float* dx, float* dweight, float* dbias) {
  const Map map = {pixels, channels};
  const Limits limits = {low, high};
  const Line line(map, weight, bias, mean, inverse);
  Sums sums(map);
  float *gradients = sums.first(), *products = sums.second();
  const float *g = dy, *v = x;
  for (std::size_t p = 0; p < pixels; ++p, g += channels, v += channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      const float dz = passed(v[c] * line.scale[c] + line.shift[c], limits, g[c]);
      gradients[c] += dz;
      products[c] += dz * (v[c] - mean[c]);
    }
    sums.end_pixel(p);
  }
  // Mean and deviation depend on x too: dx = scale dz + along x + constant.
  PerChannel<float> along, constant;
  const auto n = static_cast<float>(pixels);
  for (std::size_t c = 0; c < channels; ++c) {
    dbias[c] = static_cast<float>(sums.totals_first[c]);
    dweight[c] = static_cast<float>(sums.totals_second[c]) * inverse[c];
    along[c] = -line.scale[c] * inverse[c] * dweight[c] / n;
    constant[c] = -line.scale[c] * dbias[c] / n - along[c] * mean[c];
  }
  for (std::size_t p = 0; p < pixels; ++p, dy += channels, x += channels, dx += channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      const float dz = passed(x[c] * line.scale[c] + line.shift[c], limits, dy[c]);
      dx[c] = line.scale[c] * dz + along[c] * x[c] + constant[c];
    }
  }
}
}
