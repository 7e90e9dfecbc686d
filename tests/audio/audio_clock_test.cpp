// Tests of the time of samples: clock skew, jitter, gaps, and extreme timestamps.
#include "audio/audio_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace mien::audio {
namespace {

using Flow = AudioClock::Flow;

constexpr std::int32_t kRate = 48000;
constexpr std::size_t kBlock = 480;
constexpr std::int64_t kBlockNs = 10'000'000;

double seconds_of_block(std::int64_t block) {
  return static_cast<double>(block) * static_cast<double>(kBlock) / kRate;
}

TEST(AudioClock, CountsSamplesIfTimestampsAreExact) {
  AudioClock clock;
  EXPECT_EQ(clock.advance(5'000'000'000, kBlock, kRate), Flow::kBreak) << "the beginning";
  for (std::int64_t block = 1; block < 1000; ++block) {
    EXPECT_EQ(clock.advance(5'000'000'000 + block * kBlockNs, kBlock, kRate), Flow::kSteady);
  }
  EXPECT_EQ(clock.time_ns(2.5), 7'500'000'000);
}

TEST(AudioClock, FollowsAFastOrSlowClockForHours) {
  for (const double skew : {-50e-6, 50e-6, 200e-6}) {
    AudioClock clock;
    double worst_ns = 0.0;
    for (std::int64_t block = 0; block < std::int64_t{8} * 3600 * 100; ++block) {
      const auto pts = static_cast<std::int64_t>(
          std::llround(static_cast<double>(block) * static_cast<double>(kBlockNs) * (1.0 + skew)));
      const Flow flow = clock.advance(pts, kBlock, kRate);
      ASSERT_TRUE(flow == Flow::kSteady || block == 0);
      const double error = static_cast<double>(clock.time_ns(seconds_of_block(block)) - pts);
      worst_ns = std::max(worst_ns, std::abs(error));
    }
    EXPECT_LT(worst_ns, 0.5e6) << skew;
  }
}

TEST(AudioClock, SmoothsJitterOfTimestamps) {
  AudioClock clock;
  std::mt19937 engine(1);
  std::uniform_int_distribution<std::int64_t> jitter(-10'000'000, 10'000'000);
  (void)clock.advance(0, kBlock, kRate);
  for (std::int64_t block = 1; block < 6000; ++block) {
    ASSERT_EQ(clock.advance(block * kBlockNs + jitter(engine), kBlock, kRate), Flow::kSteady);
    const auto truth = static_cast<double>(block * kBlockNs);
    EXPECT_NEAR(static_cast<double>(clock.time_ns(seconds_of_block(block))), truth, 2e6);
  }
}

TEST(AudioClock, JumpsOverAGapAndBackAtOnce) {
  for (const std::int64_t gap : {30'000'000, 400'000'000, -30'000'000, -400'000'000}) {
    AudioClock clock;
    (void)clock.advance(0, kBlock, kRate);
    EXPECT_EQ(clock.advance(kBlockNs + gap, kBlock, kRate), Flow::kHop) << gap;
    EXPECT_EQ(clock.time_ns(seconds_of_block(1)), kBlockNs + gap);
    EXPECT_EQ(clock.advance(2 * kBlockNs + gap, kBlock, kRate), Flow::kSteady) << gap;
  }
}

// Errors do not accumulate, at any rate, gap and earlier correction.
TEST(AudioClock, MatchesTimestampsExactlyAfterAJump) {
  for (const std::int32_t rate : {11025, 44100, 48000}) {
    AudioClock clock;
    std::mt19937 engine(7);
    std::uniform_int_distribution<std::int64_t> gap(20'100'001, 400'000'000);
    std::uniform_int_distribution<std::int64_t> late(200'000, 5'000'000);
    constexpr std::size_t kFrames = 1021;
    std::int64_t frames = 0, pts = 3;
    (void)clock.advance(pts, kFrames, rate);
    for (int hop = 0; hop < 200; ++hop) {
      frames += kFrames;
      pts += static_cast<std::int64_t>(kFrames) * 1'000'000'000 / rate + late(engine);
      ASSERT_EQ(clock.advance(pts, kFrames, rate), Flow::kSteady);
      frames += kFrames;
      pts += static_cast<std::int64_t>(kFrames) * 1'000'000'000 / rate + gap(engine);
      ASSERT_EQ(clock.advance(pts, kFrames, rate), Flow::kHop);
      const double seconds = static_cast<double>(frames) / rate;
      EXPECT_NEAR(static_cast<double>(clock.time_ns(seconds) - pts), 0.0, 2.0) << rate;
    }
  }
}

TEST(AudioClock, RestartsAfterALongGap) {
  for (const std::int64_t gap : {501'000'000LL, 3'600'000'000'000LL, -501'000'000LL}) {
    AudioClock clock;
    (void)clock.advance(0, kBlock, kRate);
    EXPECT_EQ(clock.advance(kBlockNs + gap, kBlock, kRate), Flow::kBreak) << gap;
    EXPECT_EQ(clock.time_ns(0.0), kBlockNs + gap);
  }
}

TEST(AudioClock, AcceptsAnyTimestamp) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t start : {kLowest, kHighest, std::int64_t{-1}, std::int64_t{0}}) {
    for (const std::int64_t next : {kLowest, kHighest, std::int64_t{-1}, std::int64_t{0}}) {
      AudioClock clock;
      (void)clock.advance(start, kBlock, kRate);
      (void)clock.advance(next, kBlock, kRate);
      (void)clock.time_ns(1e6);
    }
  }
  // Timestamps may wrap around.
  AudioClock clock;
  (void)clock.advance(kHighest - kBlockNs + 1, kBlock, kRate);
  EXPECT_EQ(clock.advance(kLowest, kBlock, kRate), Flow::kSteady);
}

}  // namespace
}  // namespace mien::audio
