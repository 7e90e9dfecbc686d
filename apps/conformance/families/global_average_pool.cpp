// Cases of global_average_pool, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::GlobalAveragePoolArgs;

// The error of a large map's mean is that of this number of pixels.
constexpr int kMaxRoundings = 512;

Case make(const std::vector<float>& x, int pixels, int channels) {
  Arithmetic by_parts = kSingleArithmetic;
  by_parts.chunk = kMaxRoundings;
  const auto mean = [&](int c, int) {
    Sum sum(by_parts);
    for (int p = 0; p < pixels; ++p) {
      sum.add(x[blocked(c, p, pixels)]);
    }
    return sum.total() * exact(1.0 / pixels);
  };
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) + " channels";
  test.buffers = {reads(x), writes(Element::kFloat, expected_map(channels, 1, mean))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(GlobalAveragePoolArgs{buffers.floats(0), buffers.floats(1), pixels, channels});
  };
  test.call = call<GlobalAveragePoolArgs>;
  return test;
}

// Each channel has one value, so that the rounding errors of its sum have the same sign and the
// loss of every addition to a large sum shows.
std::vector<float> even_map(RandomValues& random, int pixels, int channels) {
  std::vector<float> x(as_size(pixels * padded(channels)));
  for (int c = 0; c < channels; ++c) {
    const float value = 1e-3f * static_cast<float>(random.between(1, 4999));
    for (int p = 0; p < pixels; ++p) {
      x[blocked(c, p, pixels)] = value;
    }
  }
  return x;
}

}  // namespace

// The first case is a large map.
template <>
Case random_case<GlobalAveragePoolArgs>(RandomValues& random) {
  if (random.case_number() == 0) {
    const int pixels = 65536 + random.between(0, 999), channels = random.between(5, 8);
    return make(even_map(random, pixels, channels), pixels, channels);
  }
  const int pixels = random.size(90), channels = random.size(33);
  return make(random.map(pixels, channels), pixels, channels);
}

template <>
Case typical_case<GlobalAveragePoolArgs>(RandomValues& random) {
  return make(random.map(49, 64), 49, 64);
}

}  // namespace mien::conformance
