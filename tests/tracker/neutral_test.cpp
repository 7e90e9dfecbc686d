// Tests of neutral calibration: it removes controls at rest, and a blink keeps its range.
#include "tracker/decoders/neutral.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

using tracker::kControls;
using tracker::Neutral;
using Controls = std::array<float, kControls>;

constexpr int kCaptureFrames = 55;

Controls all(float value) {
  Controls controls;
  controls.fill(value);
  return controls;
}

Controls calibrated(Neutral& neutral, float value) {
  Controls controls = all(value);
  neutral.observe(controls);
  neutral.remove(controls);
  return controls;
}

TEST(Neutral, HasNoEffectUntilCaptured) {
  Neutral neutral;
  EXPECT_EQ(calibrated(neutral, 0.3f), all(0.3f));
  neutral.capture();
  for (int frame = 0; frame < kCaptureFrames - 1; ++frame) {
    EXPECT_EQ(calibrated(neutral, 0.3f), all(0.3f));
  }
  EXPECT_FALSE(neutral.is_captured());
  EXPECT_NEAR(calibrated(neutral, 0.3f)[0], 0.0f, 1e-5f) << "the last frame";
  EXPECT_TRUE(neutral.is_captured());
  EXPECT_FALSE(neutral.is_being_captured());
}

TEST(Neutral, MapsNeutralToZeroAndOneToOne) {
  Neutral neutral;
  neutral.set(all(0.25f));
  EXPECT_EQ(calibrated(neutral, 0.1f)[0], 0.0f);
  EXPECT_EQ(calibrated(neutral, 0.25f)[0], 0.0f);
  EXPECT_NEAR(calibrated(neutral, 0.625f)[0], 0.5f, 1e-6f);
  EXPECT_EQ(calibrated(neutral, 1.0f)[0], 1.0f);
}

TEST(Neutral, ClampsSetValues) {
  Neutral neutral;
  neutral.set(all(0.9f));
  EXPECT_EQ(neutral.levels()[0], Neutral::kMax);
  neutral.set(all(-0.5f));
  EXPECT_EQ(neutral.levels()[0], 0.0f);
}

TEST(Neutral, IgnoresBlinksAndTheFirstFrames) {
  Neutral neutral;
  neutral.capture();
  for (int frame = 0; frame < kCaptureFrames; ++frame) {
    const bool blinks = frame % 20 < 7;
    (void)calibrated(neutral, frame < 10 ? 0.9f : blinks ? 1.0f : 0.2f);
  }
  EXPECT_NEAR(neutral.levels()[0], 0.2f, 1e-5f);
}

TEST(Neutral, LimitsNeutralValues) {
  Neutral neutral;
  neutral.capture();
  for (int frame = 0; frame < kCaptureFrames; ++frame) {
    (void)calibrated(neutral, 0.95f);
  }
  EXPECT_EQ(neutral.levels()[0], Neutral::kMax);
  EXPECT_NEAR(calibrated(neutral, 0.8f)[0], 0.5f, 1e-6f);
}

TEST(Neutral, RestartDiscardsFramesButKeepsTheEarlierCapture) {
  Neutral neutral;
  neutral.set(all(0.1f));
  neutral.restart();
  EXPECT_FALSE(neutral.is_being_captured()) << "no capture was running";
  neutral.capture();
  for (int frame = 0; frame < kCaptureFrames - 1; ++frame) {
    (void)calibrated(neutral, 0.5f);
  }
  neutral.restart();
  for (int frame = 0; frame < kCaptureFrames; ++frame) {
    EXPECT_EQ(neutral.levels()[0], 0.1f);
    (void)calibrated(neutral, 0.3f);
  }
  EXPECT_NEAR(neutral.levels()[0], 0.3f, 1e-5f);
}

BlobTracker unsmoothed(std::int32_t lod, std::int32_t max_faces = 1) {
  return BlobTracker({}, [=](mien_tracker_config& config) {
    config.smoothing = 0;
    config.lod = lod;
    config.max_faces = max_faces;
  });
}

Picture disc(int frame) {
  return disc_picture(160.0f + 15.0f * std::sin(0.3f * static_cast<float>(frame)), 120.0f, 70.0f);
}

std::array<std::byte, MIEN_NEUTRAL_BYTES> saved(BlobTracker& tracker, std::uint32_t& captured) {
  std::array<std::byte, MIEN_NEUTRAL_BYTES> file = {};
  EXPECT_EQ(tracker.tracker().save_neutral(file, captured), MIEN_OK);
  return file;
}

TEST(Calibration, RemovesTheControlsOfAStillFace) {
  for (const std::int32_t lod : {1, 4}) {
    BlobTracker tracker = unsmoothed(lod);
    Result raw;
    for (int frame = 0; frame < 40; ++frame) {
      raw = tracker.push(disc(0));
    }
    ASSERT_EQ(tracker.tracker().capture_neutral(), MIEN_OK);
    int counted = 0;
    Result result;
    for (int frame = 0; frame < 60; ++frame) {
      result = tracker.push(disc(0));
      counted += (result.flags & MIEN_RESULT_CAPTURING_NEUTRAL) != 0 ? 1 : 0;
    }
    EXPECT_NEAR(counted, kCaptureFrames, 1);
    for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
      const float left = std::max(0.0f, (raw.controls[i] - Neutral::kMax)) / (1 - Neutral::kMax);
      EXPECT_NEAR(result.controls[i], left, 0.02f) << i;
    }
    std::uint32_t captured = 0;
    (void)saved(tracker, captured);
    EXPECT_EQ(captured, lod == 1 ? 1u : 2u);
  }
}

TEST(Calibration, SavedAndLoadedHasTheSameEffect) {
  BlobTracker first = unsmoothed(1), second = unsmoothed(1), plain = unsmoothed(1);
  ASSERT_EQ(first.tracker().capture_neutral(), MIEN_OK);
  for (int frame = 0; frame < 60; ++frame) {
    (void)first.push(disc(frame));
    (void)second.push(disc(frame));
    (void)plain.push(disc(frame));
  }
  std::uint32_t captured = 0;
  const auto file = saved(first, captured);
  ASSERT_EQ(second.tracker().load_neutral(file), MIEN_OK);
  float difference = 0.0f;
  for (int frame = 60; frame < 90; ++frame) {
    const Result a = first.push(disc(frame)), b = second.push(disc(frame));
    const Result raw = plain.push(disc(frame));
    for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
      EXPECT_EQ(a.controls[i], b.controls[i]);
      EXPECT_LE(a.controls[i], raw.controls[i] + 1e-6f);
      difference = std::max(difference, raw.controls[i] - a.controls[i]);
    }
  }
  EXPECT_GT(difference, 0.05f) << "the neutral face must have controls above 0";
}

TEST(Calibration, ResetDiscardsIt) {
  BlobTracker tracker = unsmoothed(1), fresh = unsmoothed(1);
  ASSERT_EQ(tracker.tracker().capture_neutral(), MIEN_OK);
  for (int frame = 0; frame < 60; ++frame) {
    (void)tracker.push(disc(0));
  }
  ASSERT_EQ(tracker.tracker().reset(), MIEN_OK);
  const Result again = tracker.push(disc(0)), first = fresh.push(disc(0));
  EXPECT_TRUE(std::equal(again.controls, again.controls + MIEN_CONTROL_COUNT, first.controls));
}

class CalibrationAtLevel : public testing::TestWithParam<std::int32_t> {};
INSTANTIATE_TEST_SUITE_P(Levels, CalibrationAtLevel, testing::Values(1, 2, 4));

TEST_P(CalibrationAtLevel, WaitsForAFaceAndRestartsWhenItIsLost) {
  const std::uint32_t done = GetParam() == 1 ? 1u : 2u;
  BlobTracker tracker = unsmoothed(GetParam());
  ASSERT_EQ(tracker.tracker().capture_neutral(), MIEN_OK);
  const auto push = [&](const Picture& picture, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      (void)tracker.push(picture);
    }
    std::uint32_t captured = 0;
    (void)saved(tracker, captured);
    return captured;
  };
  EXPECT_EQ(push(Picture(320, 240), 10), 0u);
  (void)tracker.push_until_found(disc(0));
  EXPECT_EQ(push(disc(0), kCaptureFrames - 11), 0u);
  EXPECT_EQ(push(Picture(320, 240), 10), 0u);
  (void)tracker.push_until_found(disc(0));
  EXPECT_EQ(push(disc(0), kCaptureFrames - 11), 0u);
  EXPECT_EQ(push(disc(0), 12), done);
}

// A capture that continued unnoticed would take any expression as neutral.
TEST(Calibration, RestartsAtTheNewLevel) {
  for (const auto& [from, to] : {std::pair{1, 4}, {4, 1}}) {
    BlobTracker tracker = unsmoothed(from);
    (void)tracker.push(disc(0));
    ASSERT_EQ(tracker.tracker().capture_neutral(), MIEN_OK);
    for (int frame = 0; frame < 20; ++frame) {
      EXPECT_TRUE(tracker.push(disc(frame)).flags & MIEN_RESULT_CAPTURING_NEUTRAL);
    }
    ASSERT_EQ(tracker.tracker().set_lod(to), MIEN_OK);
    int counted = 0;
    for (int frame = 0; frame < 100; ++frame) {
      counted += (tracker.push(disc(frame)).flags & MIEN_RESULT_CAPTURING_NEUTRAL) != 0 ? 1 : 0;
    }
    EXPECT_NEAR(counted, kCaptureFrames, 1) << from << " to " << to;
    ASSERT_EQ(tracker.tracker().set_lod(from), MIEN_OK);
    for (int frame = 0; frame < 100; ++frame) {
      EXPECT_FALSE(tracker.push(disc(frame)).flags & MIEN_RESULT_CAPTURING_NEUTRAL);
    }
    std::uint32_t captured = 0;
    (void)saved(tracker, captured);
    EXPECT_EQ(captured, to == 1 ? 1u : 2u) << from << " to " << to;
  }
}

TEST(Calibration, RejectsInvalidCallsAndFiles) {
  BlobTracker tracker = unsmoothed(1), several = unsmoothed(1, 2);
  std::array<std::byte, MIEN_NEUTRAL_BYTES> file = {};
  std::uint32_t captured = 0;
  EXPECT_EQ(several.tracker().capture_neutral(), MIEN_ERROR_SEVERAL_FACES);
  EXPECT_EQ(several.tracker().save_neutral(file, captured), MIEN_ERROR_SEVERAL_FACES);
  EXPECT_EQ(several.tracker().load_neutral(file), MIEN_ERROR_SEVERAL_FACES);
  EXPECT_EQ(tracker.tracker().load_neutral(file), MIEN_ERROR_NEUTRAL_FORMAT);
  mien_tracker* const raw = tracker.tracker().get();
  EXPECT_EQ(mien_tracker_save_neutral(raw, file.data(), file.size() - 1, nullptr),
            MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_EQ(mien_tracker_save_neutral(raw, file.data(), file.size(), nullptr), MIEN_OK);
  EXPECT_EQ(mien_tracker_load_neutral(raw, file.data(), file.size() - 1),
            MIEN_ERROR_NEUTRAL_DAMAGED);
  file[8] = std::byte{9};
  EXPECT_EQ(tracker.tracker().load_neutral(file), MIEN_ERROR_NEUTRAL_VERSION);
  EXPECT_EQ(mien_tracker_load_neutral(raw, nullptr, 448), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_capture_neutral(nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien::tests
