// No values can make a sum exceed 32 bits, and no scale is larger than that requires.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "formats/fp16.h"
#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::tests {
namespace {

using kernels::QuantizeWeightsArgs;

constexpr int kOutBlocks = 3, kOutputs = 8 * kOutBlocks;

std::vector<std::uint16_t> random_weights(int reduction, float bias) {
  std::mt19937 random(static_cast<unsigned>(reduction));
  std::normal_distribution<float> normal(bias, 0.1f);
  std::vector<std::uint16_t> weights(static_cast<std::size_t>(reduction) * kOutputs);
  for (std::uint16_t& one : weights) {
    one = formats::fp16_from_float(normal(random));
  }
  return weights;
}

// The largest sum of an output, for inputs of maximum magnitude and matching signs.
struct Reach {
  std::int64_t above = 0, below = 0, largest = 0;
  void add(std::int64_t q) {
    (q > 0 ? above : below) += std::abs(q);
    largest = std::max(largest, std::abs(q));
  }
  [[nodiscard]] std::int64_t sum(const QuantizeWeightsArgs& a) const {
    return (a.is_signed ? above + below : std::max(above, below)) * a.max_value;
  }
};

// Two panels: 16 outputs of pairs, 8 of two pairs.
std::vector<Reach> reaches(const std::vector<std::int16_t>& pairs, int reduction) {
  std::vector<Reach> all(kOutputs);
  const std::size_t panel = static_cast<std::size_t>(reduction) * 16;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    all[i < panel ? i % 32 / 2 : 16 + (i - panel) % 32 / 4].add(pairs[i]);
  }
  return all;
}

void check(const kernels::Entry& entry, int reduction, float bias, bool is_signed) {
  const std::vector<std::uint16_t> weights = random_weights(reduction, bias);
  std::vector<std::int16_t> pairs(weights.size());
  float scales[kOutputs];
  const QuantizeWeightsArgs args{weights.data(), pairs.data(), scales,   reduction / 8,
                                 kOutBlocks,     32767,        is_signed};
  reinterpret_cast<kernels::Kernel<QuantizeWeightsArgs>>(entry.function)(args);
  for (const Reach& one : reaches(pairs, reduction)) {
    EXPECT_LT(one.sum(args), std::int64_t{1} << 31);
    const bool is_tight = one.largest >= 32766 || one.sum(args) > std::int64_t{2'000'000'000};
    EXPECT_TRUE(is_tight) << one.largest << ", " << one.sum(args);
  }
}

TEST(FixedWeights, FillThirtyTwoBitsAndNoMore) {
  int kernels = 0;
  for (const kernels::Entry& entry : kernels::all_kernels()) {
    if (entry.family != QuantizeWeightsArgs::kFamily ||
        (kernels::detect_cpu() & kernels::bit(entry.tier)) == 0) {
      continue;
    }
    ++kernels;
    for (const int reduction : {8, 24, 96, 768, 2048}) {
      for (const float bias : {0.0f, 1.0f, -0.05f}) {
        SCOPED_TRACE(std::string(kernels::name(entry.tier)) + ", " + std::to_string(reduction));
        check(entry, reduction, bias, true);
        check(entry, reduction, bias, false);
      }
    }
  }
  EXPECT_GE(kernels, 1);
}

}  // namespace
}  // namespace mien::tests
