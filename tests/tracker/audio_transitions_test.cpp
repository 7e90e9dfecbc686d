// Tests that controls do not jump when audio, a face or the level of detail changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/tracker/audio.h"
#include "tests/tracker/blob_tracker.h"
#include "tracker/decoders/controls.h"

namespace mien::tests {
namespace {

using tracker::control_named;

constexpr std::size_t kMouth[] = {control_named("jawOpen"), control_named("mouthClose"),
                                  control_named("mouthPucker"), control_named("mouthStretchLeft"),
                                  control_named("mouthUpperUpRight")};
constexpr float kSpeechAmplitude = 0.5f;

const Picture& tracked_disc() {
  static const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  return picture;
}

const Picture& empty_image() {
  static const Picture picture(320, 240);
  return picture;
}

// Largest step of a control of speech between consecutive frames.
class Steps {
 public:
  void add(const Result& result) {
    float largest = 0.0f;
    for (const std::size_t i : kMouth) {
      largest = std::max(largest, std::abs(result.controls[i] - before_.controls[i]));
    }
    steps_.push_back(known_ ? largest : 0.0f);
    before_ = result;
    known_ = true;
  }
  [[nodiscard]] float largest(std::size_t first, std::size_t end) const {
    return *std::max_element(steps_.begin() + static_cast<std::ptrdiff_t>(first),
                             steps_.begin() + static_cast<std::ptrdiff_t>(end));
  }

 private:
  bool known_ = false;
  Result before_;
  std::vector<float> steps_;
};

// Fast speech opens the jaw fully within two frames; a jump is larger.
constexpr float kJump = 0.35f;

TEST(AudioTrack, ReplacesALostFaceWithoutAJump) {
  BlobTracker blob;
  const TestAudio sound = TestAudio().add(3.9, kSpeechAmplitude);
  ASSERT_EQ(blob.tracker().push_audio(sound.all(), 0), MIEN_OK);
  Steps steps;
  for (int frame = 0; frame < 100; ++frame) {
    steps.add(blob.push(frame < 40 || frame >= 70 ? tracked_disc() : empty_image()));
  }
  EXPECT_EQ(blob.result().status, MIEN_FACE_TRACKING);
  EXPECT_LT(steps.largest(35, 69), kJump) << "the face is lost";
  EXPECT_LT(steps.largest(69, 100), kJump) << "the face returns";
}

// One level predicts the controls of speech only from audio, the other also from video.
TEST(AudioTrack, CrossfadesBetweenLevelsWithoutAJump) {
  const AlignedBytes one_control = [] {
    BlobOptions options;
    options.supported_controls = 1;
    return blob_basenet(options);
  }();
  const Weights weights = weights_of(
      {one_control.get(), blob_proposal().get(), blob_hifinet().get(), blob_audionet().get()});
  for (const auto& [from, to] : {std::pair{1, 4}, {4, 1}}) {
    const auto begin_at_from = [&, lod = from](BlobConfig& config) {
      config.use(weights);
      config.smoothing = 0;
      config.lod = lod;
    };
    BlobTracker changed({}, begin_at_from), unchanged({}, begin_at_from);
    const TestAudio sound = TestAudio().add(3.9, kSpeechAmplitude);
    ASSERT_EQ(changed.tracker().push_audio(sound.all(), 0), MIEN_OK);
    ASSERT_EQ(unchanged.tracker().push_audio(sound.all(), 0), MIEN_OK);
    float difference = 0.0f;
    for (int frame = 0; frame < 100; ++frame) {
      if (frame == 40) {
        ASSERT_EQ(changed.tracker().set_lod(to), MIEN_OK);
      }
      difference = largest_step(changed.push(tracked_disc()), unchanged.push(tracked_disc()));
      EXPECT_TRUE(frame >= 45 || difference < 0.02f) << from << " to " << to << ", frame " << frame;
    }
    EXPECT_GT(difference, 0.1f) << "the levels must differ";
  }
}

TEST(AudioTrack, FadesWithoutAJumpWhenAudioEnds) {
  BlobTracker blob;
  const TestAudio sound = TestAudio().add(1.0, kSpeechAmplitude);
  ASSERT_EQ(blob.tracker().push_audio(sound.all(), 0), MIEN_OK);
  Steps steps;
  for (int frame = 0; frame < 90; ++frame) {
    steps.add(blob.push(tracked_disc()));
  }
  EXPECT_LT(steps.largest(25, 90), kJump);
  EXPECT_LT(blob.result().voice_activity, 0.001f) << "the audio has ended";
  for (int frame = 0; frame < 200; ++frame) {
    (void)blob.push(tracked_disc());
  }
  EXPECT_EQ(blob.result().voice_activity, 0.0f);
}

}  // namespace
}  // namespace mien::tests
