#include <cmath>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::BatchNormArgs;

constexpr float kEpsilon = 1e-5f;

std::vector<float> variances(RandomValues& random, int channels) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(channels));
  for (int c = 0; c < channels; ++c) {
    values.push_back(static_cast<float>(random.between(1, 10'000)) * 1e-3f);
  }
  return values;
}

Case make(RandomValues& random, int pixels, int channels, bool in_place) {
  const std::vector<float> x = random.map(pixels, channels), mean = random.plain(channels),
                           variance = variances(random, channels), offset = random.plain(channels);
  std::vector<float> gain;
  gain.reserve(static_cast<std::size_t>(channels));
  for (int c = 0; c < channels; ++c) {
    gain.push_back(static_cast<float>(random.between(-3000, 3000)) * 1e-3f);
  }
  const std::vector<Approx> y = expected_map(channels, pixels, [&](int channel, int p) {
    const auto c = static_cast<std::size_t>(channel);
    const double factor =
        gain[c] / std::sqrt(static_cast<double>(variance[c]) + static_cast<double>(kEpsilon));
    Sum sum;
    sum.add(x[blocked(channel, p, pixels)], factor);
    sum.add(-static_cast<double>(mean[c]), factor);
    sum.add(offset[c]);
    return sum.total();
  });
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) + " channels" +
               (in_place ? ", in place" : "");
  test.buffers = {reads(mean), reads(variance), reads(gain), reads(offset)};
  test.buffers.push_back(in_place ? updates(x, y) : writes(Element::kFloat, y));
  test.buffers.push_back(reads(x));
  test.bind = [=](const Places& places) {
    return arguments(BatchNormArgs{places.floats(in_place ? 4 : 5), places.floats(4),
                                   places.floats(0), places.floats(1), places.floats(2),
                                   places.floats(3), kEpsilon, pixels, channels});
  };
  test.call = call<BatchNormArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<BatchNormArgs>(RandomValues& random) {
  const int pixels = random.size(30), channels = random.size(33);
  return make(random, pixels, channels, random.coin());
}

template <>
Case typical_case<BatchNormArgs>(RandomValues& random) {
  return make(random, 169, 16, false);
}

}  // namespace mien::conformance
