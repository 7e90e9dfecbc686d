// The values in temporal decoders are not bounded by their weights, so their sums in half precision
// saturate: no infinity or NaN may enter a state.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::tests {
namespace {

constexpr std::uint16_t kOne = 0x3C00, kMinusOne = 0xBC00;  // fp16

TEST(HalfSums, Saturate) {
  const kernels::Entry* entry =
      kernels::find_entry(kernels::FullyConnectedArgs::kFamily, kernels::kHalfTiers);
  if (entry == nullptr) {
    GTEST_SKIP() << "skipped: no tier of this CPU has such sums";
  }
  constexpr int kInputs = 16, kSums = 16;
  float x[kInputs], y[kSums];
  std::uint16_t weights[kInputs * kSums], bias[kSums] = {};
  for (int k = 0; k < kInputs; ++k) {
    x[k] = k < 8 ? 1e6f : 4e4f;
    for (int o = 0; o < kSums; ++o) {  // the first 8 outputs cancel, the others do not
      weights[k * kSums + o] = o < 8 && k % 4 < 2 ? kMinusOne : kOne;
    }
  }
  const kernels::FullyConnectedArgs args{x, weights, bias, y, {}, kInputs, kSums};
  reinterpret_cast<kernels::Kernel<kernels::FullyConnectedArgs>>(entry->function)(args);
  for (int o = 0; o < kSums; ++o) {
    EXPECT_TRUE(std::isfinite(y[o])) << o << ": " << y[o];
    EXPECT_LE(std::abs(y[o]), 2 * 65504.0f);
  }
  EXPECT_GT(y[15], 65504.0f);
}

}  // namespace
}  // namespace mien::tests
