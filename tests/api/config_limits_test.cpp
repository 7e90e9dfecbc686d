// The limits and defaults of mien_tracker_config that mien.h documents: each limit is accepted, and
// the next value beyond it is not.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

class ConfigLimits : public testing::Test {
 protected:
  template <typename Value>
  mien_status with(Value Config::*field, Value value) const {
    BlobConfig config = blob_config(basenet_, proposal_);
    config.accept_probability = 1.0f;
    config.lose_probability = 0.0f;
    config.*field = value;
    std::size_t bytes = 0;
    return mien_tracker_required_bytes(&config, &bytes, nullptr);
  }

 private:
  AlignedBytes basenet_ = blob_basenet();
  AlignedBytes proposal_ = blob_proposal();
};

TEST_F(ConfigLimits, OfIntegers) {
  struct Field {
    std::int32_t Config::*field;
    std::int32_t low, high;
  };
  const std::vector<Field> fields = {{&Config::lose_after_frames, 1, 1000},
                                     {&Config::proposal_size, 24, 640},
                                     {&Config::search_interval, 1, 1000},
                                     {&Config::max_faces, 1, 8},
                                     {&Config::audio_queue_samples, 0, 4'194'304}};
  for (const Field& f : fields) {
    const std::ptrdiff_t number = &f - fields.data();
    EXPECT_EQ(with(f.field, f.low), MIEN_OK) << number;
    EXPECT_EQ(with(f.field, f.high), MIEN_OK) << number;
    EXPECT_EQ(with(f.field, f.low - 1), MIEN_ERROR_OUT_OF_RANGE) << number;
    EXPECT_EQ(with(f.field, f.high + 1), MIEN_ERROR_OUT_OF_RANGE) << number;
  }
}

TEST_F(ConfigLimits, OfFloats) {
  struct Field {
    float Config::*field;
    float low, high;
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<Field> fields = {
      {&Config::horizontal_fov, 0.01f, 3.1f},     {&Config::accept_probability, 0.0f, 1.0f},
      {&Config::lose_probability, 0.0f, 1.0f},    {&Config::proposal_threshold, 0.0f, 1.0f},
      {&Config::refine_threshold, 0.0f, 1.0f},    {&Config::budget_ms, 0.01f, 1e6f},
      {&Config::voice_attack_ms, 0.0f, 10000.0f}, {&Config::voice_release_ms, 0.0f, 10000.0f},
      {&Config::voice_strength, 0.0f, 4.0f}};
  for (const Field& f : fields) {
    const std::ptrdiff_t number = &f - fields.data();
    EXPECT_EQ(with(f.field, f.low), MIEN_OK) << number;
    EXPECT_EQ(with(f.field, f.high), MIEN_OK) << number;
    // The library takes denormal numbers for zero.
    const float below =
        f.low == 0.0f ? -std::numeric_limits<float>::min() : std::nextafter(f.low, 0.0f);
    EXPECT_EQ(with(f.field, below), MIEN_ERROR_OUT_OF_RANGE) << number;
    EXPECT_EQ(with(f.field, std::nextafter(f.high, kInfinity)), MIEN_ERROR_OUT_OF_RANGE) << number;
    EXPECT_EQ(with(f.field, std::nanf("")), MIEN_ERROR_OUT_OF_RANGE) << number;
  }
}

TEST(ConfigDefaults, AreThoseOfTheHeader) {
  mien_tracker_config config;
  mien_tracker_config_default(&config);
  EXPECT_EQ(config.struct_size, sizeof config);
  EXPECT_EQ(config.cpu_mask, MIEN_CPU_ALL);
  EXPECT_EQ(config.lod, 1);
  EXPECT_NEAR(config.horizontal_fov, std::acos(0.5), 1e-6);
  EXPECT_EQ(config.accept_probability, 0.999f);
  EXPECT_EQ(config.lose_probability, 0.5f);
  EXPECT_EQ(config.lose_after_frames, 3);
  EXPECT_EQ(config.proposal_size, 160);
  EXPECT_EQ(config.proposal_threshold, 0.4f);
  EXPECT_EQ(config.refine_threshold, 0.2f);
  EXPECT_EQ(config.search_interval, 3);
  EXPECT_EQ(config.budget_ms, 10.0f);
  EXPECT_EQ(config.smoothing, 1);
  EXPECT_EQ(config.max_faces, 1);
  EXPECT_EQ(config.voice_attack_ms, 40.0f);
  EXPECT_EQ(config.voice_release_ms, 150.0f);
  EXPECT_EQ(config.audio_queue_samples, 0);
  EXPECT_EQ(config.voice_strength, 1.0f);
}

}  // namespace
}  // namespace mien::tests
