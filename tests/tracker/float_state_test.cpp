// The caller's floating-point state does not affect results, and calls do not change it.
#include <gtest/gtest.h>

#include <cfenv>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/tracker/blob_tracker.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace mien::tests {
namespace {

// Inputs, created in the default state.
struct Inputs {
  AlignedBytes basenet = blob_basenet(), hifinet = blob_hifinet(), proposal = blob_proposal(),
               audionet = blob_audionet();
  Buffer disc{disc_picture(150.0f, 110.0f, 70.0f), {}}, nothing{Picture(320, 240), {}};
  std::vector<float> sound = std::vector<float>(1600);

  Inputs() {
    for (std::size_t i = 0; i < sound.size(); ++i) {
      sound[i] = static_cast<float>(i % 17) / 17.0f - 0.5f;
    }
  }
};

// Runs a tracker from create to destroy in the current state.
std::vector<Result> animate() {
  static const Inputs inputs;
  BlobConfig config = blob_config(inputs.basenet, inputs.proposal, inputs.hifinet, inputs.audionet);
  config.lod = 4;
  Tracker tracker;
  EXPECT_EQ(tracker.create(config), MIEN_OK);
  Audio audio;
  audio.frames = inputs.sound.size();
  audio.samples[0] = inputs.sound.data();
  std::vector<Result> results(40);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::int64_t pts_ns = static_cast<std::int64_t>(i) * kFrameNs;
    const Buffer& scene = i < 28 ? inputs.disc : inputs.nothing;
    EXPECT_EQ(tracker.push_audio(audio, pts_ns), MIEN_OK);
    EXPECT_EQ(i % 4 == 3 ? tracker.advance(pts_ns) : tracker.push_video(scene.image(), pts_ns),
              MIEN_OK);
    EXPECT_EQ(tracker.get_result(results[i]), MIEN_OK);
  }
  return results;
}

void expect_same(const std::vector<Result>& got, const std::vector<Result>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(std::memcmp(&got[i], &expected[i], sizeof(mien_result)), 0) << i;
  }
}

TEST(FloatState, ResultsDoNotDependOnTheRoundingMode) {
  const std::vector<Result> expected = animate();
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(rounding), 0);
    const std::vector<Result> results = animate();
    EXPECT_EQ(std::fegetround(), rounding) << "restored";
    ASSERT_EQ(std::fesetround(FE_TONEAREST), 0);
    expect_same(results, expected);
  }
}

TEST(FloatState, StickyFlagsAreRestored) {
  BlobTracker blob({}, [](mien_tracker_config& config) { config.audio_queue_samples = 4096; });
  mien_tracker* const tracker = blob.tracker().get();
  const Buffer disc(disc_picture(150.0f, 110.0f, 70.0f), {});
  const std::vector<float> samples(1600, 1e-3f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Audio audio;
  audio.frames = samples.size();
  audio.samples[0] = samples.data();
  const std::vector<float> controls(MIEN_CONTROL_COUNT, 0.3f);
  std::vector<float> values(static_cast<std::size_t>(mien_vocabulary_size(MIEN_VOCABULARY_VRM1)));
  const auto count = static_cast<std::int32_t>(values.size());
  const auto expect_none = [](const char* call) {
    EXPECT_EQ(std::fetestexcept(FE_ALL_EXCEPT), 0) << call;
    std::feclearexcept(FE_ALL_EXCEPT);
  };
  std::feclearexcept(FE_ALL_EXCEPT);
  ASSERT_EQ(mien_tracker_queue_audio(tracker, &audio, 0), MIEN_OK);
  expect_none("queue_audio");
  ASSERT_EQ(mien_tracker_push_video(tracker, &disc.image(), 1), MIEN_OK);
  expect_none("push_video");
  ASSERT_EQ(mien_tracker_advance(tracker, 2), MIEN_OK);
  expect_none("advance");
  ASSERT_EQ(mien_tracker_push_audio(tracker, &audio, 3), MIEN_OK);
  expect_none("push_audio");
  ASSERT_EQ(mien_tracker_set_mix(tracker, 0, nan, nan), MIEN_ERROR_OUT_OF_RANGE);
  expect_none("set_mix");
  ASSERT_EQ(mien_vocabulary_values(MIEN_VOCABULARY_VRM1, controls.data(), values.data(), count),
            MIEN_OK);
  expect_none("vocabulary_values");
  ASSERT_EQ(mien_tracker_reset(tracker), MIEN_OK);
  expect_none("reset");
}

#if defined(__x86_64__)
TEST(FloatState, ResultsDoNotDependOnDenormalsOrTraps) {
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40, kMaskOfInvalid = 0x80,
                     kMaskOfAll = 0x1F80;
  const std::vector<Result> expected = animate();
  const Buffer disc(disc_picture(150.0f, 110.0f, 70.0f), {});
  const unsigned default_state = _mm_getcsr();
  for (const unsigned state :
       {default_state | kFlushToZero | kDenormalsAreZero, default_state & ~kFlushToZero}) {
    _mm_setcsr(state);
    const std::vector<Result> results = animate();
    EXPECT_EQ(_mm_getcsr() & ~0x3Fu, state & ~0x3Fu);
    _mm_setcsr(default_state);
    expect_same(results, expected);
  }
  // With all traps enabled, an inexact operation inside would end the program.
  BlobTracker tracker;
  _mm_setcsr((default_state & ~kMaskOfAll & ~0x3Fu));
  const mien_status pushed = mien_tracker_push_video(tracker.tracker().get(), &disc.image(), 1);
  const mien_status advanced = mien_tracker_advance(tracker.tracker().get(), 2);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(default_state);
  EXPECT_EQ(pushed, MIEN_OK);
  EXPECT_EQ(advanced, MIEN_OK);
  EXPECT_EQ(after & kMaskOfInvalid, 0u) << "the traps are restored";
}
#endif

}  // namespace
}  // namespace mien::tests
