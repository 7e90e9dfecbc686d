// Tests of lip sync: which controls audio moves, how far, when, and how fast.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "tests/tracker/audio.h"
#include "tests/tracker/blob_tracker.h"
#include "tracker/decoders/controls.h"

namespace mien::tests {
namespace {

using tracker::control_named;

constexpr std::size_t kJaw = control_named("jawOpen");
constexpr std::int64_t kMs = 1'000'000;

// The order of AudioNet's outputs: SPEECH_CONTROLS in
// models/training/mien_training/audio/audio_net.py.
constexpr std::array<std::string_view, kSpeechOutputs> kOutputs = {
    "jawOpen",           "jawForward",         "mouthClose",          "mouthFunnel",
    "mouthPucker",       "mouthRollLower",     "mouthRollUpper",      "mouthShrugLower",
    "mouthShrugUpper",   "mouthPressLeft",     "mouthPressRight",     "mouthStretchLeft",
    "mouthStretchRight", "mouthLowerDownLeft", "mouthLowerDownRight", "mouthUpperUpLeft",
    "mouthUpperUpRight", "tongueOut"};
constexpr std::size_t kJawOutput = 0, kCloseOutput = 2;

// The result for loud audio without smoothing: exactly AudioNet's outputs.
Result result_for(std::span<const float, kSpeechOutputs> outputs) {
  const AlignedBytes audionet = blob_audionet(outputs);
  BlobTracker tracker({}, [&](BlobConfig& config) {
    config.use(weights_of({blob_basenet().get(), blob_proposal().get(), audionet.get()}));
    config.smoothing = 0;
    config.voice_attack_ms = config.voice_release_ms = 0.0f;
  });
  const TestAudio sound = TestAudio().add(1.0, 0.5f);
  EXPECT_EQ(tracker.tracker().push_audio(sound.all(), 0), MIEN_OK);
  Result result;
  for (int frame = 0; frame < 15; ++frame) {
    result = tracker.advance();
  }
  EXPECT_GT(result.voice_activity, 0.99f);
  return result;
}

TEST(Speech, EveryOutputOfAudioNetMovesItsOwnControl) {
  for (std::size_t output = 0; output < kOutputs.size(); ++output) {
    std::array<float, kSpeechOutputs> outputs = {};
    outputs[output] = 0.75f;
    if (output == kCloseOutput) {
      outputs[kJawOutput] = 1.0f;  // mouthClose is limited to jawOpen
    }
    const Result result = result_for(outputs);
    for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
      const std::string_view name = mien_control_name(i);
      const bool jaw_as_well = output == kCloseOutput && name == "jawOpen";
      const float expected = name == kOutputs[output] ? 0.75f : jaw_as_well ? 1.0f : 0.0f;
      EXPECT_NEAR(result.controls[i], expected, 0.01f) << kOutputs[output] << " moves " << name;
    }
  }
}

TEST(Speech, MouthCloseIsAtMostJawOpen) {
  for (const float jaw : {0.0f, 0.25f, 0.5f}) {
    std::array<float, kSpeechOutputs> outputs = {};
    outputs[kJawOutput] = jaw;
    outputs[kCloseOutput] = 0.9f;
    const Result result = result_for(outputs);
    EXPECT_NEAR(result.controls[kJaw], jaw, 0.01f);
    EXPECT_LE(result.controls[control_named("mouthClose")], result.controls[kJaw] + 1e-6f);
  }
}

BlobTracker with_times(float attack_ms, float release_ms) {
  return BlobTracker({}, [=](mien_tracker_config& config) {
    config.smoothing = 0;
    config.voice_attack_ms = attack_ms;
    config.voice_release_ms = release_ms;
  });
}

// Advances to `time_ms` in steps of 10 ms.
Result advance_to(BlobTracker& tracker, std::int64_t time_ms) {
  std::int64_t now = tracker.now_ns() / kMs;
  for (; now + 10 <= time_ms; now += 10) {
    EXPECT_EQ(tracker.tracker().advance((now + 10) * kMs), MIEN_OK);
  }
  return tracker.result();
}

struct Transitions {
  double rises_ms = 0.0;  // above 1 - 1/e
  double falls_ms = 0.0;  // below 1/e
};

// When voice activity rises and falls, for a second of noise after half a second of silence.
Transitions transitions_with(float attack_ms, float release_ms) {
  BlobTracker tracker = with_times(attack_ms, release_ms);
  const TestAudio sound = TestAudio().add(0.5, 0.0f).add(1.0, 0.5f).add(2.0, 0.0f);
  EXPECT_EQ(tracker.tracker().push_audio(sound.all(), 0), MIEN_OK);
  const float high = 1.0f - std::exp(-1.0f), low = std::exp(-1.0f);
  Transitions transitions;
  for (std::int64_t ms = 10; ms < 3400; ms += 10) {
    EXPECT_EQ(tracker.tracker().advance(ms * kMs), MIEN_OK);
    const float activity = tracker.result().voice_activity;
    if (transitions.rises_ms == 0.0 && activity > high) {
      transitions.rises_ms = static_cast<double>(ms);
    }
    if (transitions.rises_ms != 0.0 && transitions.falls_ms == 0.0 && activity < low) {
      transitions.falls_ms = static_cast<double>(ms);
    }
  }
  return transitions;
}

TEST(Speech, FollowsAttackAndReleaseTimes) {
  const Transitions at_once = transitions_with(0.0f, 0.0f);
  EXPECT_NEAR(at_once.rises_ms, 500.0, 40.0);
  EXPECT_NEAR(at_once.falls_ms, 1500.0, 40.0);
  for (const auto& [attack_ms, release_ms] : {std::pair{50.0f, 400.0f}, {200.0f, 60.0f}}) {
    const Transitions transitions = transitions_with(attack_ms, release_ms);
    EXPECT_NEAR(transitions.rises_ms - at_once.rises_ms, attack_ms, 25.0) << attack_ms;
    EXPECT_NEAR(transitions.falls_ms - at_once.falls_ms, release_ms, 40.0) << release_ms;
  }
}

TEST(Speech, BridgesShortGapsAndFadesInLongOnes) {
  for (const int gap_ms : {100, 250, 400, 480}) {
    BlobTracker tracker = with_times(0.0f, 0.0f);
    const TestAudio sound = TestAudio().add(0.5, 0.5f);
    ASSERT_EQ(tracker.tracker().push_audio(sound.all(), 0), MIEN_OK);
    ASSERT_EQ(tracker.tracker().push_audio(sound.all(), (500 + gap_ms) * kMs), MIEN_OK);
    EXPECT_GT(advance_to(tracker, 400).voice_activity, 0.9f) << gap_ms;
    // The last window of the first part ends up to 40 ms before its end.
    const Result in_gap = advance_to(tracker, 500 + gap_ms - 60);
    EXPECT_EQ(in_gap.voice_activity > 0.9f, gap_ms == 100) << gap_ms;
    EXPECT_EQ(in_gap.voice_activity < 0.1f, gap_ms != 100) << gap_ms;
    EXPECT_GT(advance_to(tracker, 500 + gap_ms + 200).voice_activity, 0.9f) << gap_ms;
  }
}

TEST(Speech, QueueIsEmptyAfterAFrame) {
  constexpr std::int32_t kCapacity = 4096;
  BlobTracker tracker({},
                      [](mien_tracker_config& config) { config.audio_queue_samples = kCapacity; });
  const TestAudio sound = TestAudio().add(0.256, 0.5f);
  ASSERT_EQ(sound.size(), std::size_t{kCapacity});
  for (int round = 0; round < 5; ++round) {
    const std::int64_t now_ns = tracker.now_ns();
    ASSERT_EQ(tracker.tracker().queue_audio(sound.all(), now_ns), MIEN_OK) << round;
    EXPECT_EQ(tracker.tracker().queue_audio(sound.block(0, 1), now_ns),
              MIEN_ERROR_AUDIO_QUEUE_FULL);
    (void)tracker.advance();
  }
}

// Measures the weight of audio in jawOpen after a face is lost.
TEST(Speech, ReplacesALostFaceWithinATenthOfASecond) {
  const auto mix = [](BlobTracker& tracker) {
    return tracker.tracker().set_mix(static_cast<int>(kJaw), 0.25f, 0.0f);
  };
  BlobTracker tracker = with_times(0.0f, 0.0f);
  ASSERT_EQ(mix(tracker), MIEN_OK);
  const TestAudio sound = TestAudio().add(3.5, 0.5f);
  ASSERT_EQ(tracker.tracker().push_audio(sound.all(), 0), MIEN_OK);
  const Picture face = disc_picture(160.0f, 120.0f, 70.0f);
  for (int frame = 0; frame < 40; ++frame) {
    (void)tracker.push(face);
  }
  // The audio weight is 0.25 with a face and 1 without.
  EXPECT_NEAR(tracker.result().controls[kJaw], 0.25f, 0.02f);
  while (tracker.result().status == MIEN_FACE_TRACKING) {
    (void)tracker.advance();
  }
  float voice = (tracker.result().controls[kJaw] - 0.25f) / 0.75f;
  for (int frame = 0; frame < 3; ++frame) {
    const float before = voice;
    voice = (tracker.advance().controls[kJaw] - 0.25f) / 0.75f;
    EXPECT_NEAR((1 - voice) / (1 - before), std::exp(-1.0f / 3.0f), 0.02f) << frame;
  }
  EXPECT_NEAR(voice, 1 - std::exp(-4.0f / 3.0f), 0.03f) << "four frames after the loss";
}

}  // namespace
}  // namespace mien::tests
