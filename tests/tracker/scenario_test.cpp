// Tests of situations with cameras and microphones in real use.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

bool identical(const Result& a, const Result& b) {
  return std::memcmp(&a, &b, sizeof(mien_result)) == 0;
}

const Picture& disc() {
  static const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  return picture;
}

Audio block_of(const std::vector<float>& samples, std::int32_t rate, std::int32_t channels = 1) {
  Audio audio;
  audio.sample_rate = rate;
  audio.channels = channels;
  audio.frames = samples.size() / static_cast<std::size_t>(channels);
  audio.samples[0] = samples.data();
  return audio;
}

// Loud noise.
std::vector<float> noise(std::size_t count) {
  std::vector<float> samples(count);
  std::uint32_t state = 1;
  for (float& sample : samples) {
    state = state * 1664525u + 1013904223u;
    sample = static_cast<float>(state >> 8) / static_cast<float>(1u << 23) - 1.0f;
  }
  return samples;
}

TEST(Camera, DetectsAtOnceAfterRotation) {
  BlobTracker tracker;
  for (int i = 0; i < 24; ++i) {
    const Layout layout = {.rotation = 90 * (i / 3 % 4), .mirrored = i % 2 == 1};
    const Result result = tracker.push(disc(), layout);
    ASSERT_EQ(result.status, MIEN_FACE_TRACKING) << i;
    EXPECT_NEAR(result.box[0] + result.box[2] / 2, 160.0f, 3.0f) << i;
    EXPECT_NEAR(result.box[1] + result.box[3] / 2, 120.0f, 3.0f) << i;
    expect_valid(result);
  }
}

TEST(Camera, FormatChangesDoNotInterruptTracking) {
  BlobTracker tracker;
  for (int i = 0; i < 40; ++i) {
    const Result result =
        tracker.push(disc(), {.format = static_cast<mien_image_format>(i % (MIEN_IMAGE_I420 + 1)),
                              .full_range = i % 3 == 0,
                              .row_padding_bytes = i % 5,
                              .bottom_up = i % 2 == 0});
    ASSERT_EQ(result.status, MIEN_FACE_TRACKING) << i;
  }
  EXPECT_EQ(tracker.result().proposal_runs, 1u);
}

// A camera that switches between 640 x 480 and 320 x 240 shows the same face.
TEST(Camera, ResolutionChangesKeepTheFacesId) {
  BlobTracker tracker;
  EXPECT_EQ(tracker.push_until_found(disc_picture(80, 60, 60)).face_id, 1u);
  EXPECT_EQ(tracker.push_until_found(disc_picture(160, 120, 120, 640, 480)).face_id, 1u);
  EXPECT_EQ(tracker.push_until_found(disc_picture(80, 60, 60)).face_id, 1u);
  (void)tracker.push_until_found(disc_picture(160, 120, 120, 640, 480));
  EXPECT_EQ(tracker.push_until_found(disc_picture(185, 60, 60)).face_id, 2u) << "too far away";
}

TEST(Camera, WhiteAndBlackFramesLoseTheFace) {
  for (const float diameter : {0.0f, 2000.0f}) {
    BlobTracker tracker;
    (void)tracker.push(disc());
    Picture blank(320, 240);
    if (diameter > 0.0f) {
      blank.disc(160.0f, 120.0f, diameter);
    }
    for (int i = 0; i < 60; ++i) {
      expect_valid(tracker.push(blank));
    }
    EXPECT_EQ(tracker.result().status, MIEN_FACE_LOST) << diameter;
    EXPECT_EQ(tracker.push_until_found(disc()).status, MIEN_FACE_TRACKING);
  }
}

TEST(Camera, MayDropUpToThreeHundredFrames) {
  BlobTracker tracker;
  const Buffer buffer(disc(), {});
  std::int64_t pts_ns = 0;
  for (int dropped = 1; dropped <= 300; ++dropped) {
    (void)tracker.push(buffer.image(), pts_ns += kFrameNs);
    const Result after = tracker.push(buffer.image(), pts_ns += (dropped + 1) * kFrameNs);
    ASSERT_EQ(after.status, MIEN_FACE_TRACKING) << dropped;
    EXPECT_EQ((after.flags & MIEN_RESULT_CUT) != 0, (dropped + 1) * kFrameNs > kSecondNs)
        << dropped;
    expect_valid(after);
  }
  EXPECT_EQ(tracker.result().proposal_runs, 1u) << "the face did not move";
}

TEST(Camera, FadeTimeDoesNotDependOnTheFrameRate) {
  for (const int rate : {5, 12, 15, 24, 25, 30, 60, 90, 120}) {
    BlobTracker tracker({}, [](mien_tracker_config& config) { config.lose_after_frames = 1; });
    const Buffer seen(disc_picture(64.0f, 48.0f, 35.0f, 128, 96), {}), empty(Picture(128, 96), {});
    std::int64_t pts_ns = 0;
    const auto mass = [&](const mien_image& image, double seconds) {
      for (int i = 0; i < std::lround(seconds * rate); ++i) {
        pts_ns += kSecondNs / rate;
        expect_valid(tracker.push(image, pts_ns));
      }
      const Result result = tracker.result();
      float sum = 0.0f;
      for (const float control : result.controls) {
        sum += control;
      }
      return sum;
    };
    ASSERT_GT(mass(seen.image(), 2.0), 1.0f) << rate;
    while (tracker.result().status == MIEN_FACE_TRACKING) {
      (void)mass(empty.image(), 1.0 / rate);
    }
    const float at_loss = mass(empty.image(), 0.0);
    EXPECT_NEAR(mass(empty.image(), 1.0) / at_loss, std::exp(-4.0f), 2e-3f) << rate;
  }
}

// Results do not depend on the clock's origin, also near values at which timers overflow.
TEST(Clocks, OriginDoesNotChangeTheBits) {
  const std::int64_t milli = 1'000'000, micro = 1'000;
  const std::int64_t origins[] = {(std::int64_t{1} << 31) * milli,
                                  (std::int64_t{1} << 32) * micro,
                                  std::int64_t{1} << 53,
                                  std::int64_t{1} << 31,
                                  (std::int64_t{1} << 31) * kSecondNs,
                                  -(std::int64_t{1} << 40),
                                  std::numeric_limits<std::int64_t>::max() - 2 * kSecondNs,
                                  std::numeric_limits<std::int64_t>::min() + 2 * kSecondNs};
  const std::vector<float> sound = noise(1600);
  const Buffer buffer(disc(), {});
  const auto animate = [&](std::int64_t origin) {
    BlobTracker tracker;
    std::vector<Result> results;
    for (int i = -15; i < 15; ++i) {  // the origin is in the middle
      const std::int64_t pts_ns = origin + i * kFrameNs;
      EXPECT_EQ(tracker.tracker().push_audio(block_of(sound, 48000), pts_ns), MIEN_OK);
      Result result = tracker.push(buffer.image(), pts_ns);
      result.pts_ns = 0;
      results.push_back(result);
    }
    return results;
  };
  const std::vector<Result> expected = animate(0);
  EXPECT_GT(expected.back().voice_activity, 0.1f);
  for (const std::int64_t origin : origins) {
    const std::vector<Result> results = animate(origin);
    for (std::size_t i = 0; i < results.size(); ++i) {
      ASSERT_TRUE(identical(results[i], expected[i])) << "origin " << origin << ", frame " << i;
    }
  }
}

TEST(Microphone, ConstantClippedAndInvalidSamplesAreHarmless) {
  const float not_a_number = std::nanf(""), infinite = std::numeric_limits<float>::infinity();
  for (const float value : {1.0f, -1.0f, 30.0f, not_a_number, infinite, -infinite, 1e-42f, 3e38f}) {
    BlobTracker tracker;
    const std::vector<float> block(1600, value);
    for (int i = 0; i < 30; ++i) {
      EXPECT_EQ(tracker.tracker().push_audio(block_of(block, 48000), tracker.now_ns()), MIEN_OK);
      expect_valid(tracker.push(disc()));
    }
    const std::vector<float> voice = noise(48000);
    EXPECT_EQ(tracker.tracker().push_audio(block_of(voice, 48000), tracker.now_ns()), MIEN_OK);
    Result result;
    for (int i = 0; i < 20; ++i) {
      result = tracker.push(disc());
      expect_valid(result);
    }
    EXPECT_GT(result.voice_activity, 0.5f) << "speech after samples of " << value;
  }
}

TEST(Microphone, ReactsAtOnceAfterAnHourOfSilence) {
  BlobTracker tracker;
  constexpr std::int32_t kRate = 8000;
  const std::vector<float> silence(kRate, 0.0f), voice = noise(kRate);
  for (int second = 0; second < 3600; ++second) {
    ASSERT_EQ(tracker.tracker().push_audio(block_of(silence, kRate), second * kSecondNs), MIEN_OK);
    ASSERT_EQ(tracker.tracker().advance(second * kSecondNs + kSecondNs / 2), MIEN_OK);
    ASSERT_LT(tracker.result().voice_activity, 0.01f) << second;
  }
  ASSERT_EQ(tracker.tracker().push_audio(block_of(voice, kRate), 3600 * kSecondNs), MIEN_OK);
  const auto activity_at = [&](double seconds) {
    EXPECT_EQ(tracker.tracker().advance(std::llround(seconds * 1e9)), MIEN_OK);
    expect_valid(tracker.result());
    return tracker.result().voice_activity;
  };
  EXPECT_LT(activity_at(3599.9), 0.1f);
  for (double seconds = 3600.0; seconds < 3600.3; seconds += 1.0 / 30.0) {
    (void)activity_at(seconds);
  }
  EXPECT_GT(activity_at(3600.35), 0.9f);
}

TEST(Microphone, MayChangeItsFormatAtAnyTime) {
  struct Kind {
    std::int32_t rate, channels;
    bool planar, int16;
  };
  const Kind kinds[] = {{48000, 1, false, false}, {16000, 2, false, false}, {8000, 1, false, true},
                        {44100, 2, true, false},  {192000, 8, false, true}, {48000, 2, true, true}};
  BlobTracker tracker;
  float quietest = 1.0f;
  for (int i = 0; i < 90; ++i) {
    const Kind& kind = kinds[static_cast<std::size_t>(i / 3) % std::size(kinds)];
    const auto frames = static_cast<std::size_t>(kind.rate / 30);
    const std::vector<float> mono = noise(frames);
    std::vector<float> floats;
    std::vector<std::int16_t> ints;
    for (std::size_t j = 0; j < frames * static_cast<std::size_t>(kind.channels); ++j) {
      const std::size_t at = kind.planar ? j % frames : j / static_cast<std::size_t>(kind.channels);
      floats.push_back(mono[at]);
      ints.push_back(static_cast<std::int16_t>(32767.0f * mono[at]));
    }
    Audio audio = block_of(floats, kind.rate, kind.channels);
    audio.format = kind.int16 ? MIEN_SAMPLES_INT16 : MIEN_SAMPLES_FLOAT32;
    audio.planar = kind.planar ? 1 : 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(kind.channels); ++c) {
      const std::size_t at = kind.planar ? c * frames : 0;
      audio.samples[c] = kind.int16 ? static_cast<const void*>(ints.data() + at)
                                    : static_cast<const void*>(floats.data() + at);
    }
    ASSERT_EQ(tracker.tracker().push_audio(audio, tracker.now_ns()), MIEN_OK);
    const Result result = tracker.push(disc());
    expect_valid(result);
    quietest = i > 30 ? std::min(quietest, result.voice_activity) : quietest;
  }
  EXPECT_GT(quietest, 0.7f) << "uninterrupted speech";
}

TEST(Trackers, GiveTheSameResultsOnSeveralThreads) {
  const auto animate = [] {
    BlobTracker tracker;
    const std::vector<float> sound = noise(1600);
    std::vector<Result> results;
    for (int i = 0; i < 60; ++i) {
      EXPECT_EQ(tracker.tracker().push_audio(block_of(sound, 48000), tracker.now_ns()), MIEN_OK);
      results.push_back(
          tracker.push(disc_picture(100.0f + static_cast<float>(i % 40), 120.0f, 60.0f)));
    }
    return results;
  };
  const std::vector<Result> alone = animate();
  std::vector<Result> results[2];
  std::thread first([&] { results[0] = animate(); });
  std::thread second([&] { results[1] = animate(); });
  first.join();
  second.join();
  for (const auto& one : results) {
    ASSERT_EQ(one.size(), alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
      ASSERT_TRUE(identical(one[i], alone[i])) << i;
    }
  }
}

// Creates in the same memory, and sometimes with the allocator.
TEST(Trackers, MayBeCreatedManyTimes) {
  constexpr int kTimes = MIEN_CREATE_TIMES;
  const AlignedBytes basenet = blob_basenet(), proposal = blob_proposal();
  BlobConfig config = blob_config(basenet, proposal);
  config.proposal_size = 24;
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t bytes = required_bytes(config, status);
  ASSERT_EQ(status, MIEN_OK);
  const std::vector<std::byte> space(bytes);
  const AlignedBytes memory(space);
  for (int i = 0; i < kTimes; ++i) {
    mien_tracker* tracker = nullptr;
    ASSERT_EQ(i % 10 == 0
                  ? mien_tracker_create(&config, &tracker, nullptr)
                  : mien_tracker_create_in(&config, const_cast<std::byte*>(memory.get().data()),
                                           bytes, &tracker, nullptr),
              MIEN_OK)
        << i;
    mien_tracker_destroy(tracker);
  }
}

}  // namespace
}  // namespace mien::tests
