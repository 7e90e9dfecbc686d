// Tests of animation times far from 0.
#include "apps/animation/clip.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "apps/animation/resample.h"

namespace mien::animation {
namespace {

TEST(Clip, NegativeTimesAreExact) {
  std::mt19937_64 random(6);
  std::uniform_int_distribution<std::int64_t> time(std::int64_t{1} << 53, kLastTime_ns);
  for (int i = 0; i < 1000; ++i) {
    Frame before, after;
    after.time_ns = time(random);
    before.time_ns = -after.time_ns;
    EXPECT_EQ(before.time_ms(), -after.time_ms()) << after.time_ns;
  }
}

TEST(Resampler, CountsTheFramesOfAClip) {
  Frame first, last;
  first.time_ns = 1'000'000'000;
  last.time_ns = 3'000'000'000;
  EXPECT_EQ(Resampler::count(FrameSequence({first, last}), 30.0), 61.0);
  EXPECT_EQ(Resampler::count(FrameSequence({first}), 30.0), 1.0);
  EXPECT_EQ(Resampler::count(FrameSequence(), 30.0), 0.0);
}

}  // namespace
}  // namespace mien::animation
