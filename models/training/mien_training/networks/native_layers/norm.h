// Batch norm in training, followed by the limits of an activation: y = limited(scale x + shift),
// with scale and shift from the moments of x over the batch. Sums are fp32 within a block of pixels
// and fp64 over blocks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "lanes.h"

namespace mien::training {

constexpr std::size_t kMaxChannels = 1024;
constexpr std::size_t kBlock = 256;  // pixels

template <typename T>
using PerChannel = std::array<T, kMaxChannels>;

struct Map {
  std::size_t pixels, channels;
};

struct Limits {
  float low, high;
};

// The parameters and moments of a norm, one value per channel.
struct Norm {
  const float *weight, *bias;
  float *mean, *inverse;  // inverse = 1 / sqrt(variance + epsilon)
};

// Two sums per channel.
class Totals {
 public:
  void add(std::size_t channel, std::size_t count, Lanes a, Lanes b) {
    for (std::size_t i = 0; i < count; ++i) {
      first[channel + i] += a[i];
      second[channel + i] += b[i];
    }
  }

  PerChannel<double> first = {}, second = {};
};

// Calls visit(offset of the pixel's first channel, index of a channel, count) and sums its two
// results.
template <typename Visit>
void sum_over(Map map, Totals& totals, Visit visit) {
  for (std::size_t begin = 0; begin < map.pixels; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, map.pixels);
    for (std::size_t c = 0; c < map.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, map.channels - c);
      Lanes first = {}, second = {};
      for (std::size_t p = begin; p < end; ++p) {
        visit(p * map.channels + c, c, count, first, second);
      }
      totals.add(c, count, first, second);
    }
  }
}

inline void set_moments(const Totals& sums, std::size_t pixels, std::size_t channels, float epsilon,
                        Norm norm) {
  const auto n = static_cast<double>(pixels);
  for (std::size_t c = 0; c < channels; ++c) {
    const double mean = sums.first[c] / n;
    const double variance = std::max(sums.second[c] / n - mean * mean, 0.0);
    norm.mean[c] = static_cast<float>(mean);
    norm.inverse[c] = static_cast<float>(1.0 / std::sqrt(variance + epsilon));
  }
}

template <typename T>
void find_moments(const T* x, Map map, float epsilon, Norm norm) {
  Totals sums;
  sum_over(map, sums,
           [x](std::size_t at, std::size_t, std::size_t count, Lanes& values, Lanes& squares) {
             const Lanes v = load_some(x + at, count);
             values += v;
             squares += v * v;
           });
  set_moments(sums, map.pixels, map.channels, epsilon, norm);
}

// z = scale x + shift, the normalized map before the limits.
struct Line {
  explicit Line(std::size_t channels) {
    scale.fill(0.0f), shift.fill(0.0f);
    std::fill_n(scale.begin(), channels, 1.0f);
  }
  Line(std::size_t channels, Norm norm) : Line(channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      scale[c] = norm.weight[c] * norm.inverse[c];
      shift[c] = norm.bias[c] - scale[c] * norm.mean[c];
    }
  }

  Lanes at(std::size_t c, Lanes x) const { return x * load(&scale[c]) + load(&shift[c]); }

  PerChannel<float> scale, shift;
};

inline Lanes limited(Lanes z, Limits limits) {
  return smaller(larger(z, Lanes{} + limits.low), Lanes{} + limits.high);
}

inline Lanes passed(Lanes z, Limits limits, Lanes gradient) {
  const Lanes below_high = z < Lanes{} + limits.high ? gradient : Lanes{};
  return z > Lanes{} + limits.low ? below_high : Lanes{};
}

// Computes y from x.
template <typename T>
void normalise(const T* x, Map map, const Line& line, Limits limits, T* y) {
  for (std::size_t p = 0; p < map.pixels; ++p, x += map.channels, y += map.channels) {
    for (std::size_t c = 0; c < map.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, map.channels - c);
      store_some(y + c, limited(line.at(c, load_some(x + c, count)), limits), count);
    }
  }
}

// The gradient of x from that of z. The moments depend on x as well, so dx = scale dz + along x +
// constant.
struct NormBackward {
  // sums: of dz, and of dz (x - mean). Computes the gradients of weight and bias.
  NormBackward(Map map, Norm norm, const Line& line, const Totals& sums, float* dweight,
               float* dbias) {
    along.fill(0.0f), constant.fill(0.0f);
    const auto n = static_cast<float>(map.pixels);
    for (std::size_t c = 0; c < map.channels; ++c) {
      dbias[c] = static_cast<float>(sums.first[c]);
      dweight[c] = static_cast<float>(sums.second[c]) * norm.inverse[c];
      along[c] = -line.scale[c] * norm.inverse[c] * dweight[c] / n;
      constant[c] = -line.scale[c] * dbias[c] / n - along[c] * norm.mean[c];
    }
  }

  Lanes at(const Line& line, std::size_t c, Lanes dz, Lanes x) const {
    return load(&line.scale[c]) * dz + load(&along[c]) * x + load(&constant[c]);
  }

  PerChannel<float> along, constant;
};

// The sums for NormBackward, from the gradient dy of y.
template <typename T>
Totals sum_gradients(const T* dy, const T* x, Map map, Norm norm, const Line& line, Limits limits) {
  Totals sums;
  PerChannel<float> mean = {};
  std::copy_n(norm.mean, map.channels, mean.begin());
  sum_over(
      map, sums,
      [&](std::size_t at, std::size_t c, std::size_t count, Lanes& gradients, Lanes& products) {
        const Lanes v = load_some(x + at, count);
        const Lanes dz = passed(line.at(c, v), limits, load_some(dy + at, count));
        gradients += dz;
        products += dz * (v - load(&mean[c]));
      });
  return sums;
}

}  // namespace mien::training
