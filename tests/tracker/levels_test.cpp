// Tests of the levels of detail: which encoders run when, and changes without a jump.
#include "tracker/encoders/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

Picture circling_disc(int frame) {
  const float phase = 0.11f * static_cast<float>(frame);
  return disc_picture(160.0f + 12.0f * std::cos(phase), 120.0f + 8.0f * std::sin(phase), 70.0f);
}

BlobTracker tracker_at(std::int32_t lod) {
  return BlobTracker({}, [lod](mien_tracker_config& config) { config.lod = lod; });
}

TEST(Levels, EncodersRunOnTheDocumentedFrames) {
  const std::uint64_t runs[4][2] = {{1, 0}, {2, 0}, {2, 1}, {2, 2}};  // on even and odd frames
  for (std::int32_t lod = 1; lod <= 4; ++lod) {
    BlobTracker tracker = tracker_at(lod);
    Result before = tracker.push(circling_disc(0));
    for (int frame = 1; frame < 21; ++frame) {
      const Result result = tracker.push(circling_disc(frame));
      ASSERT_EQ(result.status, MIEN_FACE_TRACKING);
      EXPECT_EQ(result.encoder_runs - before.encoder_runs, runs[lod - 1][frame % 2])
          << "level " << lod << ", frame " << frame;
      EXPECT_EQ(result.lod, lod);
      before = result;
    }
  }
}

TEST(Levels, ControlsChangeOnEveryFrame) {
  for (std::int32_t lod = 1; lod <= 4; ++lod) {
    BlobTracker tracker = tracker_at(lod);
    Result before = tracker.push(circling_disc(0));
    for (int frame = 1; frame < 6; ++frame) {
      const Result after = tracker.push(circling_disc(frame));
      EXPECT_GT(largest_step(before, after), 0.0f) << "level " << lod << ", frame " << frame;
      before = after;
    }
  }
}

TEST(Levels, ControlsComeFromHiFiNetFromLevelTwo) {
  BlobTracker one = tracker_at(1), two = tracker_at(2), four = tracker_at(4);
  Result last[3];
  for (int frame = 0; frame < 60; ++frame) {
    const Picture still = circling_disc(0);
    last[0] = one.push(still);
    last[1] = two.push(still);
    last[2] = four.push(still);
  }
  EXPECT_GT(largest_step(last[0], last[2]), 0.02f);
  EXPECT_LT(largest_step(last[1], last[2]), 0.01f) << "the same image on every frame";
}

TEST(Levels, HiFiNetRefinesLandmarksFromLevelTwo) {
  constexpr double kHiFiNetWeight = 0.8;  // in the mean of both networks' landmarks
  BlobTracker one = tracker_at(1);
  for (const std::int32_t lod : {2, 3, 4}) {
    BlobTracker refined = tracker_at(lod);
    for (int frame = 0; frame < 20; ++frame) {
      const Picture still = circling_disc(0);
      const Result coarse = one.push(still), fine = refined.push(still);
      double dx = 0.0, dy = 0.0;
      for (int i = 0; i < MIEN_LANDMARK_COUNT; ++i) {
        dx += (fine.landmarks[i][0] - coarse.landmarks[i][0]) / MIEN_LANDMARK_COUNT;
        dy += (fine.landmarks[i][1] - coarse.landmarks[i][1]) / MIEN_LANDMARK_COUNT;
      }
      EXPECT_NEAR(dx / fine.box[2], kHiFiNetWeight * kRefinedBy, 0.003)
          << "level " << lod << ", frame " << frame;
      EXPECT_NEAR(dy / fine.box[2], 0.0, 0.003);
    }
  }
}

TEST(Levels, ChangesDoNotMakeControlsJump) {
  for (const auto& [from, to] : {std::pair{1, 4}, {4, 1}, {2, 3}, {3, 2}, {1, 2}, {4, 2}, {2, 4}}) {
    BlobTracker tracker = tracker_at(from);
    Result before;
    int frame = 0;
    for (; frame < 30; ++frame) {
      before = tracker.push(circling_disc(frame));
    }
    float usual = 0.0f;
    for (; frame < 90; ++frame) {
      const Result after = tracker.push(circling_disc(frame));
      usual = std::max(usual, largest_step(before, after));
      before = after;
    }
    ASSERT_EQ(tracker.tracker().set_lod(to), MIEN_OK);
    float at_switch = 0.0f, later = 0.0f;
    for (; frame < 220; ++frame) {
      const Result after = tracker.push(circling_disc(frame));
      float& largest = frame < 155 ? at_switch : later;
      largest = std::max(largest, largest_step(before, after));
      before = after;
    }
    EXPECT_EQ(before.lod, to);
    EXPECT_LE(at_switch, std::max(usual, later) + 0.012f) << from << " to " << to;
  }
}

TEST(Levels, ChangedTrackerConvergesToAnUnchangedOne) {
  for (const std::int32_t to : {1, 3}) {
    BlobTracker changed = tracker_at(to == 1 ? 4 : 1), always = tracker_at(to);
    Result a, b;
    for (int frame = 0; frame < 200; ++frame) {
      if (frame == 30) {
        ASSERT_EQ(changed.tracker().set_lod(to), MIEN_OK);
      }
      a = changed.push(circling_disc(0));
      b = always.push(circling_disc(0));
    }
    EXPECT_LT(largest_step(a, b), 0.01f);
    EXPECT_EQ(a.supported_controls, b.supported_controls);
  }
}

// BaseNet predicts only the first control.
BlobTracker tracker_with_few_at_level_1(std::int32_t lod) {
  BlobOptions options;
  options.supported_controls = 1;
  return BlobTracker({}, [&](BlobConfig& config) {
    config.use(weights_of({blob_basenet(options).get(), blob_proposal().get(), blob_hifinet().get(),
                           blob_audionet().get()}));
    config.lod = lod;
  });
}

TEST(Levels, UnsupportedControlsAreZeroDuringACrossfade) {
  BlobTracker tracker = tracker_with_few_at_level_1(4);
  int frame = 0;
  for (; frame < 30; ++frame) {
    (void)tracker.push(circling_disc(frame));
  }
  ASSERT_EQ(tracker.tracker().set_lod(1), MIEN_OK);
  Result before = tracker.result();
  for (; frame < 120; ++frame) {
    const Result result = tracker.push(circling_disc(frame));
    EXPECT_LT(largest_step(before, result), 0.2f) << frame;
    for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
      EXPECT_TRUE(result.supports(i) || result.controls[i] == 0.0f) << i << ", frame " << frame;
    }
    before = result;
  }
  EXPECT_EQ(before.supported_controls, 1u);
}

TEST(Levels, LandmarksAreRefinedAtOnceAfterRaisingTheLevel) {
  for (const std::int32_t to : {2, 3, 4}) {
    for (const int frames : {1, 2}) {  // the next is an alternate frame or not
      BlobTracker tracker = tracker_at(1), always = tracker_at(to);
      for (int frame = 0; frame < frames; ++frame) {
        (void)tracker.push(circling_disc(0));
        (void)always.push(circling_disc(0));
      }
      ASSERT_EQ(tracker.tracker().set_lod(to), MIEN_OK);
      const Result raised = tracker.push(circling_disc(0)), refined = always.push(circling_disc(0));
      const float shift = kRefinedBy * refined.box[2];
      EXPECT_GT(raised.landmarks[0][0], refined.landmarks[0][0] - 0.5f * shift) << to;
    }
  }
}

// Features from before a time at level 1 are too old for the decoder.
TEST(Levels, HiFiNetRunsOnTheFirstImageAfterLevelOne) {
  for (const std::int32_t back_to : {2, 3, 4}) {
    for (const int frames_at_one : {7, 8}) {  // BaseNet runs on every second one
      BlobTracker tracker = tracker_at(4);
      for (int frame = 0; frame < 10; ++frame) {
        (void)tracker.push(circling_disc(0));
      }
      ASSERT_EQ(tracker.tracker().set_lod(1), MIEN_OK);
      for (int frame = 0; frame < frames_at_one; ++frame) {
        (void)tracker.push(circling_disc(frame));
      }
      const std::uint64_t before = tracker.result().encoder_runs;
      ASSERT_EQ(tracker.tracker().set_lod(back_to), MIEN_OK);
      EXPECT_EQ(tracker.push(circling_disc(20)).encoder_runs, before + 2)
          << "to level " << back_to << " after " << frames_at_one;
    }
  }
}

TEST(Levels, RejectsLevelsWithoutWeights) {
  const auto without = [](BlobConfig& config) {
    config.use(weights_of({blob_basenet().get(), blob_proposal().get()}));
  };
  BlobTracker tracker({}, without);
  EXPECT_EQ(tracker.tracker().set_lod(2), MIEN_ERROR_UNSUPPORTED_LOD);
  EXPECT_EQ(tracker.tracker().set_lod(5), MIEN_ERROR_UNSUPPORTED_LOD);
  EXPECT_EQ(tracker.tracker().set_lod(-1), MIEN_ERROR_UNSUPPORTED_LOD);
  EXPECT_EQ(tracker.tracker().set_lod(0), MIEN_OK);
  EXPECT_EQ(tracker.push(circling_disc(0)).lod, 1);
}

TEST(Levels, ResetRestoresTheConfiguredLevel) {
  BlobTracker tracker = tracker_at(3);
  (void)tracker.push(circling_disc(0));
  ASSERT_EQ(tracker.tracker().set_lod(1), MIEN_OK);
  EXPECT_EQ(tracker.push(circling_disc(1)).lod, 1);
  ASSERT_EQ(tracker.tracker().reset(), MIEN_OK);
  EXPECT_EQ(tracker.push(circling_disc(2)).lod, 3);
}

TEST(Levels, ResetDiscardsMeasuredLoad) {
  BlobTracker tracker({}, [](mien_tracker_config& config) {
    static std::uint64_t now = 0;
    config.clock_user = &now;
    config.clock_ns = [](void* user) { return *static_cast<std::uint64_t*>(user) += 50'000'000; };
    config.lod = 0;
  });
  for (int frame = 0; frame < 75; ++frame) {
    (void)tracker.push(circling_disc(frame));
  }
  ASSERT_LT(tracker.result().lod, 4);
  ASSERT_EQ(tracker.tracker().reset(), MIEN_OK);
  EXPECT_EQ(tracker.push(circling_disc(0)).lod, 4);
}

// A clock that advances by step_ns with each call. A frame with more work calls it more often.
struct Clock {
  std::uint64_t now = 0, step_ns = 0;
};

BlobTracker timed_tracker(Clock& clock, std::int32_t lod) {
  return BlobTracker({}, [&clock, lod](mien_tracker_config& config) {
    config.clock_user = &clock;
    config.clock_ns = [](void* user) {
      auto& read = *static_cast<Clock*>(user);
      return read.now += read.step_ns;
    };
    config.lod = lod;
  });
}

TEST(Levels, AutomaticStartsAtThePreviousLevelWithoutItsCost) {
  Clock clock;
  BlobTracker tracker = timed_tracker(clock, 4);
  clock.step_ns = 50'000'000;  // far above the budget
  int frame = 0;
  for (; frame < 300; ++frame) {
    EXPECT_EQ(tracker.push(circling_disc(frame)).lod, 4);
  }
  clock.step_ns = 1;
  ASSERT_EQ(tracker.tracker().set_lod(0), MIEN_OK);
  for (; frame < 400; ++frame) {
    EXPECT_EQ(tracker.push(circling_disc(frame)).lod, 4);
  }
  ASSERT_EQ(tracker.tracker().set_lod(2), MIEN_OK);
  (void)tracker.push(circling_disc(frame));
  ASSERT_EQ(tracker.tracker().set_lod(0), MIEN_OK);
  EXPECT_EQ(tracker.push(circling_disc(frame)).lod, 2);
}

// The detection after a change of size does not count as the cost of a tracked frame.
TEST(Levels, AutomaticMeasuresOnlyFramesWithATrackedFace) {
  Clock clock;
  BlobTracker tracker = timed_tracker(clock, 0);
  clock.step_ns = 50'000'000;
  for (int frame = 0; frame < 100; ++frame) {
    const float scale = frame % 2 == 0 ? 1.0f : 1.5f;
    const Result result =
        tracker.push(disc_picture(160.0f * scale, 120.0f * scale, 70.0f * scale,
                                  static_cast<int>(320 * scale), static_cast<int>(240 * scale)));
    EXPECT_TRUE(result.has_face());
    EXPECT_EQ(result.lod, 4);
  }
}

// The level after `seconds` of frames that take `ms` milliseconds at each level.
std::int32_t settled(tracker::LevelGovernor& governor, const float (&ms)[4], float seconds) {
  for (float t = 0.0f; t < seconds; t += 1.0f / 30.0f) {
    const std::int32_t level = std::clamp(governor.level(), 1, 4);
    EXPECT_EQ(governor.level(), level);
    governor.account(static_cast<std::uint64_t>(ms[level - 1] * 1e6f), 1.0f / 30.0f);
  }
  return governor.level();
}

TEST(LevelGovernor, ChoosesTheHighestLevelThatFits) {
  const float ms[] = {3.0f, 15.5f, 18.0f, 30.5f};
  const struct {
    float budget;
    std::int32_t level;
  } expected[] = {{40.0f, 4}, {22.0f, 3}, {16.5f, 2}, {10.0f, 1}, {1.0f, 1}};
  for (const auto& [budget, level] : expected) {
    tracker::LevelGovernor governor(budget, 4);
    EXPECT_EQ(settled(governor, ms, 20.0f), level) << "budget " << budget;
    EXPECT_EQ(settled(governor, ms, 20.0f), level) << "stable";
  }
}

// Cost of the next level relative to this one.
constexpr float kGrowth[] = {5.9f, 1.2f, 1.7f};

// A level that barely fits the budget would be left at the next slow frame.
TEST(LevelGovernor, RaisesTheLevelOnlyWithHeadroom) {
  constexpr float kBudgetMs = 20.0f;
  for (std::int32_t level = 1; level <= 3; ++level) {
    for (const float budget_fraction : {0.80f, 0.84f, 0.86f, 0.95f}) {
      tracker::LevelGovernor governor(kBudgetMs, 4);
      governor.begin_at(level);
      const float ms = budget_fraction * kBudgetMs / kGrowth[level - 1];
      for (int frame = 0; frame < 75; ++frame) {
        governor.account(static_cast<std::uint64_t>(ms * 1e6f), 1.0f / 30.0f);
      }
      EXPECT_EQ(governor.level(), budget_fraction < 0.85f ? level + 1 : level)
          << "from level " << level << ", " << budget_fraction << " of the budget";
    }
  }
}

TEST(LevelGovernor, RaisesTheLevelAgainWhenTheLoadFalls) {
  const float busy[] = {9.0f, 46.0f, 54.0f, 91.0f}, calm[] = {3.0f, 15.5f, 18.0f, 30.5f};
  tracker::LevelGovernor governor(40.0f, 4);
  EXPECT_EQ(settled(governor, busy, 20.0f), 1);
  EXPECT_EQ(settled(governor, calm, 20.0f), 4);
}

TEST(LevelGovernor, ChangesAtMostOnceInTwoSeconds) {
  tracker::LevelGovernor governor(20.0f, 4);
  float since = 100.0f;
  std::int32_t level = governor.level();
  for (int frame = 0; frame < 3000; ++frame) {
    const float ms = frame / 40 % 2 == 0 ? 1.0f : 200.0f;
    governor.account(static_cast<std::uint64_t>(ms * 1e6f), 1.0f / 30.0f);
    since += 1.0f / 30.0f;
    if (governor.level() != level) {
      EXPECT_GE(since, 1.99f);
      level = governor.level();
      since = 0.0f;
    }
  }
}

}  // namespace
}  // namespace mien::tests
