// Compares the engine with PyTorch, on every tier of this CPU. Both use the same fp16 weights and
// fp32 sums in different order, so the tolerance is relative to the largest output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/tier.h"
#include "tests/engine/mini_model.h"
#include "tests/engine/twin_session.h"
#include "tests/kernels/every_tier.h"

namespace mien::tests {
namespace {

constexpr double kTolerance = 2e-5, kHalfTolerance = 1e-2;

class Golden : public testing::TestWithParam<std::uint32_t> {};

void expect_close(const std::vector<float>& got, std::span<const float> want,
                  std::uint32_t cpu_mask) {
  const double tolerance = is_half(cpu_mask) ? kHalfTolerance : kTolerance;
  ASSERT_EQ(got.size(), want.size());
  double largest = 0.0;
  for (const float one : want) {
    largest = std::max(largest, std::abs(static_cast<double>(one)));
  }
  for (std::size_t i = 0; i < want.size(); ++i) {
    ASSERT_NEAR(got[i], want[i], tolerance * largest) << "element " << i;
  }
}

TEST_P(Golden, Encoder) {
  MiniSession mini("encoder", {}, GetParam());
  ASSERT_EQ(mini.status, MIEN_OK);
  const std::vector<float> input = golden("encoder_input");
  std::copy(input.begin(), input.end(), mini.session->input().begin());
  mini.session->run();
  expect_close(unblocked(mini.session->output(0), mini.session->output_shape(0)),
               golden("encoder_output"), GetParam());
}

TEST_P(Golden, FullyConvolutionalOnALargerImage) {
  MiniSession mini("pnet", {31, 31, 3}, GetParam());
  ASSERT_EQ(mini.status, MIEN_OK);
  const std::vector<float> input = golden("pnet_input");
  ASSERT_EQ(input.size(), mini.session->input().size());
  std::copy(input.begin(), input.end(), mini.session->input().begin());
  mini.session->run();
  ASSERT_EQ(mini.session->output_count(), 2u);
  for (std::uint32_t i = 0; i < 2; ++i) {
    expect_close(unblocked(mini.session->output(i), mini.session->output_shape(i)),
                 golden("pnet_output" + std::to_string(i)), GetParam());
  }
}

TEST_P(Golden, TemporalNetworkStepByStepAndAgainAfterReset) {
  MiniSession mini("temporal", {}, GetParam());
  ASSERT_EQ(mini.status, MIEN_OK);
  const std::vector<float> inputs = golden("temporal_input"), wanted = golden("temporal_output");
  std::vector<float> first_round;
  for (int round = 0; round < 2; ++round) {
    std::vector<float> outputs;
    for (std::size_t step = 0; step < inputs.size() / 12; ++step) {
      std::copy_n(inputs.begin() + static_cast<std::ptrdiff_t>(12 * step), 12,
                  mini.session->input().begin());
      mini.session->run();
      const auto output = mini.session->output(0);
      outputs.insert(outputs.end(), output.begin(), output.begin() + 10);
    }
    expect_close(outputs, wanted, GetParam());
    if (round == 0) {
      first_round = outputs;
    } else {
      EXPECT_EQ(outputs, first_round);  // bit for bit
    }
    mini.session->reset();
  }
}

INSTANTIATE_TEST_SUITE_P(Tiers, Golden, testing::ValuesIn(tiers_here()));

}  // namespace
}  // namespace mien::tests
