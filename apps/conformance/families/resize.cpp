// Cases of resize, with the expected results.
#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::Grid;
using kernels::ResizeArgs;
using kernels::Sampling;

// In double precision: sizes are so small that only exact halves are near a half.
double position(Grid grid, int i, int in, int out) {
  const double scale = static_cast<double>(in) / out;
  switch (grid) {
    case Grid::kHalfPixel:
      return (i + 0.5) * scale - 0.5;
    case Grid::kAsymmetric:
      return static_cast<double>(i) * in / out;
    case Grid::kAlignCorners:
      break;
  }
  return out > 1 ? static_cast<double>(i) * (in - 1) / (out - 1) : 0.0;
}

double rounded_position(Sampling sampling, double at) {
  constexpr double kTiny = 1e-9;
  switch (sampling) {
    case Sampling::kRoundHalfDown:
      return std::ceil(at - 0.5 - kTiny);
    case Sampling::kRoundHalfUp:
      return std::floor(at + 0.5 + kTiny);
    case Sampling::kFloor:
      return std::floor(at + kTiny);
    case Sampling::kCeil:
      return std::ceil(at - kTiny);
    case Sampling::kBilinear:
      break;
  }
  return at;
}

struct Along {
  int low, high;
  double weight;
};

Along along(Grid grid, Sampling sampling, int i, int in, int out) {
  const double at =
      std::clamp(rounded_position(sampling, position(grid, i, in, out)), 0.0, in - 1.0);
  const int low = static_cast<int>(at);
  return {low, std::min(low + 1, in - 1), at - low};
}

struct Maps {
  int in_h, in_w, out_h, out_w, channels;
};

Case make(RandomValues& random, const Maps& maps, Grid grid, Sampling sampling) {
  const std::vector<float> x = random.map(maps.in_h * maps.in_w, maps.channels);
  const int in_pixels = maps.in_h * maps.in_w, out_pixels = maps.out_h * maps.out_w;
  const auto at = [&](int c, int p) {
    const Along row = along(grid, sampling, p / maps.out_w, maps.in_h, maps.out_h);
    const Along column = along(grid, sampling, p % maps.out_w, maps.in_w, maps.out_w);
    const auto pixel = [&](int y, int z) {
      return static_cast<double>(x[blocked(c, y * maps.in_w + z, in_pixels)]);
    };
    if (sampling != Sampling::kBilinear) {
      return exact(pixel(row.low, column.low));
    }
    Sum sum;
    sum.add(pixel(row.low, column.low), (1 - row.weight) * (1 - column.weight));
    sum.add(pixel(row.low, column.high), (1 - row.weight) * column.weight);
    sum.add(pixel(row.high, column.low), row.weight * (1 - column.weight));
    sum.add(pixel(row.high, column.high), row.weight * column.weight);
    // The rounding error of a weight is relative to 1, not to the weight.
    double largest = 0.0;
    for (const int y : {row.low, row.high}) {
      for (const int z : {column.low, column.high}) {
        largest = std::max(largest, std::abs(pixel(y, z)));
      }
    }
    Approx total = sum.total();
    total.error += kSumFactor * kUnit * largest + 4 * kFlushed;
    return total;
  };
  Case test;
  test.shape = times(maps.in_h, maps.in_w) + " to " + times(maps.out_h, maps.out_w) + "x" +
               std::to_string(maps.channels) + ", grid " + std::to_string(static_cast<int>(grid)) +
               ", sampling " + std::to_string(static_cast<int>(sampling));
  test.buffers = {reads(x), writes(Element::kFloat, expected_map(maps.channels, out_pixels, at))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(ResizeArgs{buffers.floats(0), buffers.floats(1), maps.in_h, maps.in_w,
                                maps.out_h, maps.out_w, maps.channels, grid, sampling});
  };
  test.call = call<ResizeArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<ResizeArgs>(RandomValues& random) {
  Maps maps{random.between(1, 9), random.size(12), 0, 0, random.size(20)};
  const bool whole = random.coin();  // an integer factor, for which halves are likely
  maps.out_h = whole ? maps.in_h * random.between(1, 4) : random.between(1, 20);
  maps.out_w = whole ? maps.in_w * random.between(1, 4) : random.size(26);
  const auto grid = static_cast<Grid>(random.between(0, 2));
  const auto sampling = static_cast<Sampling>(random.between(0, 4));
  return make(random, maps, grid, sampling);
}

template <>
Case typical_case<ResizeArgs>(RandomValues& random) {
  return make(random, {14, 14, 28, 28, 64}, Grid::kHalfPixel, Sampling::kBilinear);
}

}  // namespace mien::conformance
