// Compares the engine with plain layers.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kernels/tier.h"
#include "tests/engine/owned_session.h"
#include "tests/engine/twin_network.h"
#include "tests/kernels/every_tier.h"

namespace mien::tests {

// Relative to the largest value of a map. The engine keeps activations in fp32 and sums in another
// order; plain layers use double throughout.
inline constexpr double kTwinTolerance = 1e-5;
// For tiers that compute in half precision: values cancel more in networks with random weights than
// in trained ones.
inline constexpr double kHalfTwinTolerance = 3e-2;
inline double twin_tolerance(std::uint32_t cpu_mask) {
  return is_half(cpu_mask) ? kHalfTwinTolerance : kTwinTolerance;
}

inline AlignedBuffer finished(const formats::MienWriter& writer) {
  std::vector<std::byte> bytes;
  const mien_error_detail validation = writer.finish(&bytes);
  EXPECT_EQ(validation.status, MIEN_OK)
      << mien_status_string(static_cast<mien_status>(validation.status));
  return AlignedBuffer(std::span<const std::byte>(bytes));
}

inline void set_input(engine::Session& session, const Map& input) {
  const engine::Shape& shape = session.input_shape();
  for (std::size_t p = 0; p < input.h * input.w; ++p) {
    for (std::size_t c = 0; c < input.c; ++c) {
      const std::size_t at =
          shape.interleaved() ? p * input.c + c : (c / 8 * input.h * input.w + p) * 8 + c % 8;
      session.input()[at] = static_cast<float>(input.values[p * input.c + c]);
    }
  }
}

// Expects the same values, and zeros in lanes without a channel.
inline void expect_map(const engine::Session& session, std::uint32_t output, const Map& want,
                       double tolerance) {
  const engine::Shape shape = session.output_shape(output);
  ASSERT_EQ(shape,
            (engine::Shape{static_cast<std::int32_t>(want.h), static_cast<std::int32_t>(want.w),
                           static_cast<std::int32_t>(want.c)}));
  const std::vector<float> got = unblocked(session.output(output), shape);
  double largest = 1e-3, total = 0, used = 0;
  for (const double one : want.values) {
    largest = std::max(largest, std::abs(one));
  }
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(got[i]), want.values[i], tolerance * largest)
        << "output " << output << ", element " << i;
    used += std::abs(static_cast<double>(got[i]));
  }
  for (const float one : session.output(output)) {
    total += std::abs(static_cast<double>(one));
  }
  EXPECT_NEAR(total, used, 1e-12 * used) << "a lane without a channel is not zero";
}

// Runs both for a number of steps. Fills the arena with NaNs before each.
inline void expect_twins_agree(const formats::MienWriter& writer, const std::string& name,
                               TwinNetwork& twin, std::uint32_t cpu_mask, int steps = 3,
                               double slack = 1) {
  OwnedSession engine(finished(writer), name, {}, cpu_mask);
  ASSERT_EQ(engine.status, MIEN_OK) << mien_status_string(engine.status);
  twin.reset();
  for (int step = 0; step < steps; ++step) {
    const Map input = twin.random_input();
    set_input(*engine.session, input);
    engine.fill_arena_with_nan();
    engine.session->run();
    const std::vector<Map> want = twin.run(input);
    for (std::uint32_t i = 0; i < twin.outputs().size(); ++i) {
      ASSERT_NO_FATAL_FAILURE(
          expect_map(*engine.session, i, want[twin.outputs()[i]], slack * twin_tolerance(cpu_mask)))
          << "step " << step;
    }
  }
}

// The tiers of this CPU, with two masks each: layer by layer and fused.
inline std::vector<std::uint32_t> tiers_here() {
  std::vector<std::uint32_t> masks;
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if ((kernels::detect_cpu() & 1u << tier) != 0) {
      masks.push_back(kernels::up_to(static_cast<kernels::Tier>(tier)));
      masks.push_back(masks.back() | kernels::kFusedBlocks);
    }
  }
  return masks;
}

}  // namespace mien::tests
