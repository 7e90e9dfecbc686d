// Tests of detection, tracking and loss, with a disc as the face.
#include <gtest/gtest.h>

#include <vector>

#include <cmath>
#include <numeric>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

void expect_box_on_disc(const Result& result, float x, float y, float diameter) {
  const float side = diameter / kDiscPerCrop;
  EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
  EXPECT_NEAR(result.box[0] + result.box[2] / 2, x, 0.02f * side);
  EXPECT_NEAR(result.box[1] + result.box[3] / 2, y, 0.02f * side);
  EXPECT_NEAR(result.box[2], side, 0.06f * side);
  EXPECT_EQ(result.box[2], result.box[3]);
}

TEST(Tracking, ResultIsEmptyBeforeTheFirstImage) {
  BlobTracker tracker;
  const Result result = tracker.result();
  EXPECT_EQ(result.status, MIEN_FACE_SEARCHING);
  EXPECT_EQ(result.frames, 0u);
  for (float control : result.controls) {
    EXPECT_EQ(control, 0.0f);
  }
}

TEST(Tracking, DetectsDiscsOfAllSizesEverywhere) {
  for (float diameter : {20.0f, 33.0f, 60.0f, 110.0f, 160.0f}) {
    for (float x : {0.5f, 0.35f, 0.7f}) {
      SCOPED_TRACE(testing::Message() << diameter << " at " << x);
      BlobTracker tracker;
      const Result result = tracker.push(disc_picture(320 * x, 125.0f, diameter));
      expect_box_on_disc(result, 320 * x, 125.0f, diameter);
      EXPECT_TRUE(result.flags & MIEN_RESULT_FOUND);
      EXPECT_TRUE(result.flags & MIEN_RESULT_PROPOSAL_RAN);
      EXPECT_GT(result.face_probability, 0.9f);
      expect_valid(result);
    }
  }
}

// With this size the last band of the largest pyramid level overlaps the previous one.
TEST(Tracking, DetectsSmallDiscsInEveryBand) {
  constexpr float kSmall = 21.0f;  // only the largest pyramid level detects it
  for (float y = 30.0f; y < 230.0f; y += 12.0f) {
    BlobTracker tracker({}, [](mien_tracker_config& config) { config.proposal_size = 100; });
    const Result result = tracker.push(disc_picture(150.0f, y, kSmall));
    ASSERT_EQ(result.status, MIEN_FACE_TRACKING) << y;
    expect_box_on_disc(result, 150.0f, y, kSmall);
  }
}

// P-Net's score of a disc is below this threshold: only thorough detection, with a quarter of it,
// finds a disc.
constexpr float kUnreachableThreshold = 1.0f;

TEST(Tracking, DetectionOnTheFirstImageIsThorough) {
  BlobTracker tracker(
      {}, [](mien_tracker_config& config) { config.proposal_threshold = kUnreachableThreshold; });
  EXPECT_TRUE(tracker.push(disc_picture(160.0f, 120.0f, 70.0f)).flags & MIEN_RESULT_FOUND);
}

TEST(Tracking, LaterDetectionsAreThoroughAsWell) {
  BlobTracker tracker(
      {}, [](mien_tracker_config& config) { config.proposal_threshold = kUnreachableThreshold; });
  tracker.push(Picture(320, 240));
  const Result result = tracker.push_until_found(disc_picture(160.0f, 120.0f, 70.0f));
  EXPECT_EQ(result.proposal_runs, 2u) << "that of the empty image, a thorough one";
}

TEST(Tracking, LandmarksSurroundTheDisc) {
  BlobTracker tracker;
  const Result result = tracker.push(disc_picture(150.0f, 110.0f, 70.0f));
  float x = 0.0f;
  float lowest = 1e9f;
  float highest = -1e9f;
  for (const auto& point : result.landmarks) {
    x += point[0] / MIEN_LANDMARK_COUNT;
    lowest = std::min(lowest, point[1]);
    highest = std::max(highest, point[1]);
  }
  EXPECT_NEAR(x, 150.0f, 5.0f);
  EXPECT_NEAR((highest - lowest) / result.box[3], 0.8f, 0.03f);
}

TEST(Tracking, TracksAMovingGrowingDiscWithoutDetection) {
  BlobTracker tracker;
  Result result;
  for (int i = 0; i < 90; ++i) {
    const float phase = 0.07f * static_cast<float>(i);
    const float x = 160.0f + 60.0f * std::cos(phase);
    const float y = 120.0f + 40.0f * std::sin(phase);
    const float diameter = 60.0f + 15.0f * std::sin(0.5f * phase);
    result = tracker.push(disc_picture(x, y, diameter));
    ASSERT_EQ(result.status, MIEN_FACE_TRACKING) << i;
    EXPECT_LT(
        std::hypot(result.box[0] + result.box[2] / 2 - x, result.box[1] + result.box[3] / 2 - y),
        0.12f * result.box[2])
        << i;
    expect_valid(result);
  }
  EXPECT_EQ(result.proposal_runs, 1u);
  EXPECT_EQ(result.frames, 90u);
  EXPECT_EQ(result.face_frames, 90u);
}

TEST(Tracking, EncoderRunsOnAlternateFrames) {
  BlobTracker tracker;
  const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  const std::uint64_t initial_runs = tracker.push(picture).encoder_runs;
  EXPECT_GE(initial_runs, 2u);
  for (int i = 1; i <= 20; ++i) {
    const bool runs = i % 2 == 0;
    EXPECT_EQ((tracker.push(picture).flags & MIEN_RESULT_ENCODER_RAN) != 0, runs) << i;
  }
  EXPECT_EQ(tracker.result().encoder_runs, initial_runs + 10);
}

TEST(Tracking, DecodersRunOnEveryFrame) {
  BlobTracker tracker;
  const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  Result before = tracker.push(picture);
  for (int i = 0; i < 4; ++i) {
    const Result after = tracker.push(picture);
    EXPECT_FALSE(std::equal(after.controls, after.controls + MIEN_CONTROL_COUNT, before.controls))
        << "the recurrent state must change";
    before = after;
  }
}

TEST(Tracking, LosesAFaceAfterSeveralMissesAndThenFades) {
  BlobTracker tracker({}, [](mien_tracker_config& config) { config.lose_after_frames = 4; });
  const Picture disc = disc_picture(160.0f, 120.0f, 70.0f);
  const Picture nothing(320, 240);
  Result shown;
  for (int i = 0; i < 3; ++i) {
    shown = tracker.push(disc);  // after an odd number the encoder runs on the next image
  }
  int held = 0;
  Result result = tracker.push(nothing);
  while (result.status == MIEN_FACE_TRACKING) {
    ++held;
    ASSERT_LT(held, 20);
    EXPECT_EQ(result.box[0], shown.box[0]);
    result = tracker.push(nothing);
  }
  EXPECT_GE(held, 3);
  EXPECT_LE(held, 4);
  EXPECT_EQ(result.status, MIEN_FACE_LOST);
  EXPECT_EQ(result.box[0], shown.box[0]) << "the last position is kept";
  const float mass = std::accumulate(result.controls, result.controls + MIEN_CONTROL_COUNT, 0.0f);
  ASSERT_GT(mass, 1.0f);
  for (int i = 0; i < 30; ++i) {
    result = tracker.push(nothing);
  }
  const float left = std::accumulate(result.controls, result.controls + MIEN_CONTROL_COUNT, 0.0f);
  EXPECT_NEAR(left / mass, std::exp(-4.0f), 1e-3f) << "one second at 0.25 s";
  expect_valid(result);
}

TEST(Tracking, SurvivesSingleMisses) {
  BlobTracker tracker;
  const Picture disc = disc_picture(160.0f, 120.0f, 70.0f);
  for (int i = 0; i < 30; ++i) {
    const bool hidden = i % 3 == 2;  // always a frame on which the encoder runs
    const Result result = tracker.push(hidden ? Picture(320, 240) : disc);
    EXPECT_EQ(result.status, MIEN_FACE_TRACKING) << i;
  }
  EXPECT_EQ(tracker.result().proposal_runs, 1u);
}

TEST(Tracking, DetectsTheFaceAgainElsewhere) {
  BlobTracker tracker;
  for (int i = 0; i < 5; ++i) {
    (void)tracker.push(disc_picture(80.0f, 80.0f, 60.0f));
  }
  Result result;
  for (int i = 0; i < 40; ++i) {
    result = tracker.push(disc_picture(250.0f, 170.0f, 50.0f));
  }
  expect_box_on_disc(result, 250.0f, 170.0f, 50.0f);
  EXPECT_LE(result.proposal_runs, 2u);
}

TEST(Tracking, DiscontinuityLosesAndDetectsOnTheSameFrame) {
  BlobTracker tracker;
  for (int i = 0; i < 4; ++i) {
    (void)tracker.push(disc_picture(80.0f, 80.0f, 60.0f));
  }
  const Buffer elsewhere(disc_picture(250.0f, 170.0f, 50.0f), {});
  const Result result = tracker.push(elsewhere.image(), 3'600'000'000'000);
  EXPECT_TRUE(result.flags & MIEN_RESULT_CUT);
  EXPECT_TRUE(result.flags & MIEN_RESULT_FOUND);
  expect_box_on_disc(result, 250.0f, 170.0f, 50.0f);
}

TEST(Tracking, DiscontinuityWithoutAnImageStartsDetectionOnTheNext) {
  for (const std::int32_t lod : {1, 4}) {
    BlobTracker tracker({}, [=](mien_tracker_config& config) { config.lod = lod; });
    for (int i = 0; i < 4; ++i) {
      (void)tracker.push(disc_picture(80.0f, 80.0f, 60.0f));
    }
    ASSERT_EQ(tracker.tracker().advance(tracker.now_ns() + 5'000'000'000), MIEN_OK);
    EXPECT_TRUE(tracker.result().flags & MIEN_RESULT_CUT);
    const Buffer elsewhere(disc_picture(250.0f, 170.0f, 50.0f), {});
    const Result result = tracker.push(elsewhere.image(), tracker.now_ns() + 5'100'000'000);
    EXPECT_TRUE(result.flags & MIEN_RESULT_FOUND) << "level " << lod;
  }
}

TEST(Tracking, NewSizeStartsDetectionAtOnceAfterAnyTimeWithoutAFace) {
  for (int empty = 28; empty < 38; ++empty) {
    BlobTracker tracker;
    for (int i = 0; i < empty; ++i) {
      (void)tracker.push(Picture(160, 120));
    }
    EXPECT_TRUE(tracker.push(disc_picture(160.0f, 120.0f, 70.0f)).has_face()) << empty;
  }
}

// The same scene with another image size.
TEST(Tracking, FaceKeepsItsIdWhenTheImageSizeChanges) {
  for (const float scale : {0.5f, 2.0f, 3.0f}) {
    for (const std::int32_t faces : {1, 2}) {
      BlobTracker tracker({}, [=](mien_tracker_config& config) { config.max_faces = faces; });
      for (int i = 0; i < 3; ++i) {
        (void)tracker.push(disc_picture(220.0f, 150.0f, 60.0f));
      }
      const Picture scaled =
          disc_picture(220.0f * scale, 150.0f * scale, 60.0f * scale, static_cast<int>(320 * scale),
                       static_cast<int>(240 * scale));
      for (int i = 0; i < 10; ++i) {
        const Result result = tracker.push(scaled);
        EXPECT_TRUE(result.has_face()) << scale;
        EXPECT_EQ(result.face_id, 1u) << scale;
      }
      EXPECT_EQ(tracker.tracker().face_count(), 1);
    }
  }
}

TEST(Tracking, FaceAtAnotherPlaceAfterASizeChangeGetsANewId) {
  BlobTracker tracker;
  (void)tracker.push(disc_picture(80.0f, 80.0f, 40.0f));
  const Result result = tracker.push(disc_picture(80.0f, 80.0f, 90.0f, 1280, 960));
  EXPECT_TRUE(result.has_face());
  EXPECT_EQ(result.face_id, 2u);
}

// More frames than images: every image shows the face.
TEST(Tracking, FramesWithoutImagesDoNotLoseAVisibleFace) {
  for (std::int32_t lod = 1; lod <= 4; ++lod) {
    BlobTracker tracker({}, [=](mien_tracker_config& config) { config.lod = lod; });
    (void)tracker.push(disc_picture(160.0f, 120.0f, 70.0f));
    for (int i = 0; i < 30; ++i) {
      EXPECT_TRUE(tracker.advance().has_face()) << "level " << lod;
      EXPECT_TRUE(tracker.advance().has_face()) << "level " << lod;
      EXPECT_TRUE(tracker.push(disc_picture(160.0f, 120.0f, 70.0f)).has_face()) << "level " << lod;
    }
    EXPECT_EQ(tracker.result().proposal_runs, 1u);
  }
}

TEST(Tracking, DiscontinuityResetsTheDecoders) {
  const Buffer disc(disc_picture(160.0f, 120.0f, 70.0f), {});
  const auto distance = [](const Result& a, const Result& b) {
    float largest = 0.0f;
    for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
      largest = std::max(largest, std::abs(a.controls[i] - b.controls[i]));
    }
    return largest;
  };
  BlobTracker tracker;
  const Result first = tracker.push(disc.image());
  Result before;
  for (int i = 0; i < 8; ++i) {
    before = tracker.push(disc.image());
  }
  const Result cut = tracker.push(disc.image(), -1);
  EXPECT_EQ(cut.proposal_runs, 1u) << "the face is still there";
  EXPECT_GT(distance(cut, before), 0.01f);
  EXPECT_LT(distance(cut, first), 0.005f);
}

TEST(Tracking, DetectionResetsTheDecoders) {
  const Picture disc = disc_picture(160.0f, 120.0f, 70.0f);
  const auto above_lowest = [](mien_tracker_config& config) { config.lod = 2; };
  BlobTracker fresh({}, above_lowest);  // where every detection has the same number of alignments,
  (void)fresh.push(Picture(320, 240));  // except in a new scene
  const Result first = fresh.push_until_found(disc);
  BlobTracker used({}, above_lowest);
  for (int i = 0; i < 7; ++i) {
    (void)used.push(disc);
  }
  Result found_again;
  for (int i = 0; i < 11; ++i) {  // then the next roll of the detector is 0
    found_again = used.push(Picture(320, 240));
  }
  ASSERT_EQ(found_again.status, MIEN_FACE_LOST);
  found_again = used.push_until_found(disc);
  EXPECT_TRUE(
      std::equal(found_again.controls, found_again.controls + MIEN_CONTROL_COUNT, first.controls));
}

TEST(Tracking, DetectsLessOftenAfterAWhile) {
  BlobTracker tracker({}, [](mien_tracker_config& config) { config.search_interval = 60; });
  const Picture nothing(64, 48);
  const auto searches = [&](int frames) {
    const std::uint64_t before = tracker.result().proposal_runs;
    int frames_with_detection = 0;
    for (int i = 0; i < frames; ++i) {
      frames_with_detection +=
          (tracker.push(nothing).flags & MIEN_RESULT_PROPOSAL_RAN) != 0 ? 1 : 0;
    }
    return std::pair(tracker.result().proposal_runs - before, frames_with_detection);
  };
  EXPECT_EQ(searches(1), (std::pair<std::uint64_t, int>(1, 1))) << "the first runs on one image";
  const auto [detections_early, early_frames] = searches(29);
  EXPECT_EQ(early_frames, 29) << "one after the other";
  EXPECT_GE(detections_early, 2u);
  EXPECT_LE(detections_early, 10u) << "each is spread over several images";
  const auto [detections_late, late_frames] = searches(310);
  EXPECT_EQ(detections_late, 5u);
  EXPECT_LT(late_frames, 200);
  EXPECT_EQ(tracker.result().status, MIEN_FACE_SEARCHING);
}

TEST(Tracking, SearchIntervalOfOneDetectsOnEveryFrame) {
  BlobTracker tracker({}, [](mien_tracker_config& config) { config.search_interval = 1; });
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_TRUE(tracker.push(Picture(64, 48)).flags & MIEN_RESULT_PROPOSAL_RAN) << frame;
  }
}

TEST(Tracking, OnlyTheFirstFrameRunsAWholeDetection) {
  BlobTracker tracker;
  const Result first = tracker.push(Picture(320, 240));
  EXPECT_EQ(first.proposal_runs, 1u);
  int frames = 1;
  while (tracker.push(Picture(320, 240)).proposal_runs < 3 && frames < 50) {
    ++frames;
  }
  EXPECT_GE(frames, 4) << "the second detection took several images";
}

// A detection that is spread over equal images finds the same as one on a single image.
TEST(Tracking, DetectionInChunksFindsTheSameAsInOneFrame) {
  for (const float diameter : {20.0f, 47.0f, 150.0f}) {
    const Picture disc = disc_picture(211.0f, 103.0f, diameter);
    BlobTracker at_once, spread;
    const Result whole = at_once.push(disc);
    (void)spread.push(Picture(320, 240));
    const Result found = spread.push_until_found(disc);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(found.box[i], whole.box[i], 0.02f * whole.box[2]) << diameter;
    }
  }
}

TEST(Tracking, BaseNetRejectsDetections) {
  BlobOptions never;
  never.face_bias = -1000.0f;
  BlobTracker tracker(never);
  const Result result = tracker.push(disc_picture(160.0f, 120.0f, 70.0f));
  EXPECT_EQ(result.status, MIEN_FACE_SEARCHING);
  EXPECT_GT(result.encoder_runs, 0u) << "it was detected and encoded";
  EXPECT_LT(result.face_probability, 0.01f);
}

TEST(Tracking, DetectionsThatRNetRejectsAreNotEncoded) {
  BlobTracker tracker({}, [](mien_tracker_config& config) { config.proposal_threshold = 0.0f; });
  EXPECT_EQ(tracker.push(Picture(320, 240)).encoder_runs, 0u);
}

// The highest face probability that is rejected, with this bias of the detector score.
float max_rejected_probability(const Picture& picture, float refine_bias) {
  BlobOptions doubtful;
  doubtful.refine_bias = refine_bias;
  Result result = BlobTracker(doubtful).push(picture);
  EXPECT_TRUE(result.has_face());
  while (result.has_face()) {
    doubtful.face_bias -= 0.5f;
    result = BlobTracker(doubtful).push(picture);
  }
  return result.face_probability;
}

// Tracking starts only above the probability that keeps it, unless the detector score is high.
TEST(Tracking, AcceptsMoreStrictlyThanItTracks) {
  mien_tracker_config config;
  mien_tracker_config_default(&config);
  const Picture disc = disc_picture(160.0f, 120.0f, 70.0f);
  const float with_low_score = max_rejected_probability(disc, 0.0f),
              with_high_score = max_rejected_probability(disc, 5.0f);
  EXPECT_GT(with_low_score, config.lose_probability);
  EXPECT_LT(with_high_score, with_low_score);
  EXPECT_LT(with_high_score, config.accept_probability);
  EXPECT_GE(max_rejected_probability(disc, 100.0f), config.lose_probability) << "the lower limit";
}

TEST(Tracking, UnsupportedControlsStayZero) {
  BlobOptions some;
  some.supported_controls = 0x5;
  BlobTracker tracker(some);
  const Result result = tracker.push(disc_picture(160.0f, 120.0f, 70.0f));
  EXPECT_EQ(result.supported_controls, 0x5u);
  EXPECT_TRUE(result.supports(MIEN_CONTROL_EYE_LOOK_IN_LEFT));
  EXPECT_FALSE(result.supports(MIEN_CONTROL_EYE_LOOK_DOWN_LEFT));
  EXPECT_GT(result.control(MIEN_CONTROL_EYE_BLINK_LEFT), 0.0f);
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    EXPECT_TRUE(result.supports(i) || result.controls[i] == 0.0f) << i;
  }
}

TEST(Tracking, StagesAreTimedByTheCallersClock) {
  BlobTracker tracker({}, [](mien_tracker_config& config) {
    static std::uint64_t now = 0;
    config.clock_user = &now;
    config.clock_ns = [](void* user) { return *static_cast<std::uint64_t*>(user) += 10; };
  });
  const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  const std::vector<float> silence(1600, 0.0f);
  Audio audio;
  audio.frames = silence.size();
  audio.samples[0] = silence.data();
  ASSERT_EQ(tracker.tracker().push_audio(audio, 0), MIEN_OK);
  Result result = tracker.push(picture);
  for (int stage = 0; stage < MIEN_STAGE_COUNT; ++stage) {
    EXPECT_GT(result.stage_ns[stage], 0u) << mien_stage_name(stage);
  }
  EXPECT_EQ(result.stage_ns[MIEN_STAGE_COUNT], 0u);
  result = tracker.push(picture);  // an alternate frame
  EXPECT_EQ(result.stage_ns[MIEN_STAGE_SOUND], 0u);
  EXPECT_EQ(result.stage_ns[MIEN_STAGE_PROPOSAL], 0u);
  EXPECT_EQ(result.stage_ns[MIEN_STAGE_ENCODER], 0u);
  EXPECT_EQ(result.stage_ns[MIEN_STAGE_DECODERS], 10u);
}

}  // namespace
}  // namespace mien::tests
