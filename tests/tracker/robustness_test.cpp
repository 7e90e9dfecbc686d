// Tests with unusual streams: sizes, timestamps and invalid images.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

bool identical(const Result& a, const Result& b) {
  return std::memcmp(&a, &b, sizeof(mien_result)) == 0;
}

Picture moving_disc(int frame) {
  const auto x = static_cast<float>(frame % 40);
  return disc_picture(100.0f + 2.0f * x, 120.0f, 50.0f + x / 2.0f);
}

TEST(Reset, IsBitIdenticalToANewTracker) {
  BlobTracker used;
  for (int i = 0; i < 23; ++i) {
    (void)used.push(moving_disc(i));
  }
  ASSERT_EQ(used.tracker().reset(), MIEN_OK);
  BlobTracker fresh;
  EXPECT_TRUE(identical(used.result(), fresh.result()));
  for (int i = 0; i < 23; ++i) {
    const std::int64_t pts = 1000 + i * kFrameNs;
    const Buffer buffer(moving_disc(3 * i), {});
    EXPECT_TRUE(identical(used.push(buffer.image(), pts), fresh.push(buffer.image(), pts))) << i;
  }
}

TEST(Reset, TrackersDoNotAffectEachOther) {
  BlobTracker alone;
  BlobTracker first;
  BlobTracker second;
  for (int i = 0; i < 12; ++i) {
    const Picture picture = moving_disc(i);
    const Result result = first.push(picture);
    (void)second.push(moving_disc(20 + 2 * i));
    EXPECT_TRUE(identical(alone.push(picture), result)) << i;
  }
}

TEST(Timestamps, AnyValueIsAccepted) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();
  const Buffer disc(disc_picture(160.0f, 120.0f, 70.0f), {});
  const Buffer nothing(Picture(320, 240), {});
  BlobTracker tracker;
  std::mt19937_64 random(5);
  std::int64_t pts = 0;
  for (int i = 0; i < 400; ++i) {
    const std::int64_t choices[] = {pts,
                                    kLowest,
                                    kHighest,
                                    0,
                                    -1,
                                    static_cast<std::int64_t>(random()),
                                    3'600'000'000'000,
                                    i * kFrameNs};
    pts = choices[random() % std::size(choices)];
    const Result result = tracker.push(random() % 3 == 0 ? nothing.image() : disc.image(), pts);
    EXPECT_EQ(result.pts_ns, pts);
    expect_valid(result);
  }
  EXPECT_EQ(tracker.result().frames, 400u);
}

TEST(Timestamps, TrackingContinuesWhenTheyRepeat) {
  BlobTracker tracker;
  for (int i = 0; i < 10; ++i) {
    const Buffer buffer(moving_disc(i), {});
    const Result result = tracker.push(buffer.image(), 77);
    EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
    EXPECT_FALSE(result.flags & MIEN_RESULT_CUT);
  }
  EXPECT_EQ(tracker.result().proposal_runs, 1u);
}

TEST(Images, MayHaveAnySizeInOneStream) {
  BlobTracker tracker;
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    const int width = i == 0 ? 1 : 1 + static_cast<int>(random() % 300);
    const int height = i == 0 ? 1 : 1 + static_cast<int>(random() % 200);
    Picture picture(width, height);
    if (i % 2 == 0) {
      picture.noise(static_cast<unsigned>(i));
    } else {
      picture.disc(static_cast<float>(width) / 2, static_cast<float>(height) / 2, 40.0f);
    }
    const auto format = static_cast<mien_image_format>(random() % (MIEN_IMAGE_I420 + 1));
    const int rotation = 90 * static_cast<int>(random() % 4);
    expect_valid(tracker.push(picture, {.format = format,
                                        .rotation = rotation,
                                        .mirrored = random() % 2 == 0,
                                        .row_padding_bytes = static_cast<int>(random() % 5),
                                        .bottom_up = random() % 2 == 0}));
  }
}

TEST(Images, NewSizeStartsDetectionOnTheSameFrame) {
  BlobTracker tracker;
  (void)tracker.push(disc_picture(160.0f, 120.0f, 70.0f, 320, 240));
  const Result result = tracker.push(disc_picture(320.0f, 240.0f, 140.0f, 640, 480));
  EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
  EXPECT_TRUE(result.flags & MIEN_RESULT_FOUND);
  EXPECT_FALSE(result.flags & MIEN_RESULT_CUT);
}

TEST(Images, NewSizeCancelsARunningDetection) {
  BlobTracker tracker;
  (void)tracker.push(Picture(320, 240));                        // whole detection
  while (tracker.push(Picture(320, 240)).proposal_runs < 2u) {  // the first chunk of the next
  }
  const Result result = tracker.push(disc_picture(320.0f, 240.0f, 140.0f, 640, 480));
  EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
  EXPECT_EQ(result.proposal_runs, 3u);
}

TEST(Images, MayBeFourK) {
  BlobTracker tracker;
  const Buffer buffer(disc_picture(2600.0f, 900.0f, 700.0f, 3840, 2160),
                      {.format = MIEN_IMAGE_NV12});
  const Result result = tracker.push(buffer.image());
  EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
  EXPECT_NEAR(result.box[0] + result.box[2] / 2, 2600.0f, 20.0f);
  EXPECT_NEAR(result.box[1] + result.box[3] / 2, 900.0f, 20.0f);
}

TEST(Images, BlackWhiteAndNoiseGiveValidResults) {
  BlobOptions everything;
  everything.face_bias = 1000.0f;
  BlobTracker tracker(everything);
  for (int i = 0; i < 60; ++i) {
    Picture picture(160, 120);
    if (i % 3 == 0) {
      picture.noise(static_cast<unsigned>(i));
    } else if (i % 3 == 1) {
      picture.disc(80.0f, 60.0f, i % 2 == 0 ? 1000.0f : 50.0f);
    }
    expect_valid(tracker.push(picture));
  }
}

TEST(Images, InvalidOnesDoNotChangeTheTracker) {
  BlobTracker disturbed;
  BlobTracker steady;
  for (int i = 0; i < 8; ++i) {
    const Buffer buffer(moving_disc(i), {});
    mien_image wrong = buffer.image();
    wrong.width = -5;
    const Result before = disturbed.result();
    EXPECT_EQ(disturbed.tracker().push_video(wrong, 0), MIEN_ERROR_IMAGE_SIZE);
    EXPECT_TRUE(identical(before, disturbed.result()));
    EXPECT_TRUE(identical(disturbed.push(buffer.image()), steady.push(buffer.image())));
  }
}

// The caller's memory may be gone or overwritten as soon as push returns.
TEST(Images, AreReadOnlyDuringTheCall) {
  BlobTracker keeping;
  BlobTracker freeing;
  const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  const Buffer kept(picture, {});
  for (int i = 0; i < 6; ++i) {
    const Result a = keeping.push(kept.image());
    Result b;
    {
      Buffer scrapped(picture, {});
      b = freeing.push(scrapped.image());
      std::memset(const_cast<void*>(scrapped.image().planes[0]), 0xFF,
                  static_cast<std::size_t>(320 * 240 * 3));
    }
    EXPECT_TRUE(identical(a, b)) << i;
  }
}

}  // namespace
}  // namespace mien::tests
