// Random sequences of calls: results depend only on the valid inputs since the last reset.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

constexpr unsigned kInterleavings = MIEN_INTERLEAVINGS;
constexpr int kCalls = 12;

// A repeatable call that changes the state of a tracker.
using Call = std::function<void(mien_tracker*)>;

class Calls {
 public:
  explicit Calls(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

  Call next() {
    switch (below(8)) {
      case 0:
      case 1:
      case 2:
        return push_video();
      case 3:
      case 4:
        return push_audio();
      case 5:
        return [pts = now()](mien_tracker* t) { EXPECT_EQ(mien_tracker_advance(t, pts), MIEN_OK); };
      case 6:
        return [lod = static_cast<std::int32_t>(below(5))](mien_tracker* t) {
          EXPECT_EQ(mien_tracker_set_lod(t, lod), MIEN_OK);
        };
      default:
        return setting();
    }
  }

 private:
  std::int64_t now() {
    constexpr std::int64_t kSteps[] = {kFrameNs, kFrameNs,      kFrameNs,     kFrameNs / 2,
                                       0,        1'500'000'000, -200'000'000, 3 * kFrameNs};
    return now_ns_ += kSteps[below(std::size(kSteps))];
  }

  static const std::vector<Buffer>& buffers() {
    static const std::vector<Buffer> buffers = [] {
      std::vector<Buffer> all;
      for (const float x : {40.0f, 47.0f, 60.0f}) {
        all.emplace_back(disc_picture(x, 36.0f, 30.0f, 96, 72), Layout());
        all.emplace_back(disc_picture(x, 36.0f, 30.0f, 96, 72), Layout{.format = MIEN_IMAGE_NV12});
      }
      all.emplace_back(Picture(96, 72), Layout());
      all.emplace_back(disc_picture(50.0f, 30.0f, 30.0f, 96, 72), Layout{.rotation = 90});
      return all;
    }();
    return buffers;
  }

  Call push_video() {
    const Buffer& buffer = buffers()[below(buffers().size())];
    return [&buffer, pts = now()](mien_tracker* t) {
      EXPECT_EQ(mien_tracker_push_video(t, &buffer.image(), pts), MIEN_OK);
    };
  }

  Call push_audio() {
    constexpr std::int32_t kRates[] = {8000, 16000, 48000};
    std::vector<float> samples(1 + below(2000));
    for (float& sample : samples) {
      sample = static_cast<float>(below(2001)) / 1000.0f - 1.0f;
    }
    return [samples, rate = kRates[below(3)], pts = now_ns_](mien_tracker* t) {
      mien_audio audio;
      mien_audio_default(&audio);
      audio.sample_rate = rate;
      audio.frames = samples.size();
      audio.samples[0] = samples.data();
      EXPECT_EQ(mien_tracker_push_audio(t, &audio, pts), MIEN_OK);
    };
  }

  Call setting() {
    switch (below(3)) {
      case 0:
        return [](mien_tracker* t) { EXPECT_EQ(mien_tracker_capture_neutral(t), MIEN_OK); };
      case 1:
        return [control = static_cast<std::int32_t>(below(MIEN_CONTROL_COUNT)),
                weight = static_cast<float>(below(11)) / 10.0f](mien_tracker* t) {
          EXPECT_EQ(mien_tracker_set_mix(t, control, weight, 1.0f - weight), MIEN_OK);
        };
      default:
        return [offset = static_cast<std::int64_t>(below(100)) * 1'000'000](mien_tracker* t) {
          EXPECT_EQ(mien_tracker_set_audio_offset(t, offset), MIEN_OK);
        };
    }
  }

  std::mt19937 random_;
  std::int64_t now_ns_ = 0;
};

// Calls without effect: rejected and read-only ones.
void call_without_effect(mien_tracker* tracker, std::size_t choice) {
  mien_image image;
  mien_image_default(&image);
  mien_audio audio;
  mien_audio_default(&audio);
  audio.sample_rate = 7;
  mien_result result;
  mien_result_default(&result);
  switch (choice) {
    case 0:
      EXPECT_EQ(mien_tracker_push_video(tracker, &image, 0), MIEN_ERROR_IMAGE_SIZE);
      break;
    case 1:
      EXPECT_EQ(mien_tracker_push_audio(tracker, &audio, 0), MIEN_ERROR_AUDIO_RATE);
      break;
    case 2:
      EXPECT_EQ(mien_tracker_set_lod(tracker, 5), MIEN_ERROR_UNSUPPORTED_LOD);
      break;
    default:
      EXPECT_EQ(mien_tracker_get_result(tracker, &result), MIEN_OK);
  }
}

Result result_of(const mien_tracker* tracker) {
  Result result;
  EXPECT_EQ(mien_tracker_get_result(tracker, &result), MIEN_OK);
  return result;
}

TEST(Interleavings, GiveTheSameBitsAsAReplay) {
  const auto small_search = [](mien_tracker_config& config) { config.proposal_size = 48; };
  BlobTracker disturbed({}, small_search), replayed({}, small_search), another({}, small_search);
  std::uint64_t face_frames = 0;
  for (unsigned seed = 0; seed < kInterleavings; ++seed) {
    Calls calls(seed), others(seed + 1'000'000);
    mien_tracker* const tracker = disturbed.tracker().get();
    std::vector<Call> since_reset;
    for (int i = 0; i < kCalls; ++i) {
      if (i == 0 || calls.below(16) == 0) {
        ASSERT_EQ(mien_tracker_reset(tracker), MIEN_OK);
        since_reset.clear();
      }
      since_reset.push_back(calls.next());
      since_reset.back()(tracker);
      call_without_effect(tracker, calls.below(4));
      if (i % 4 == 0) {
        others.next()(another.tracker().get());
      }
    }
    const Result got = result_of(tracker);
    mien_tracker* const straight = replayed.tracker().get();
    ASSERT_EQ(mien_tracker_reset(straight), MIEN_OK);
    for (const Call& call : since_reset) {
      call(straight);
    }
    const Result expected = result_of(straight);
    ASSERT_EQ(std::memcmp(&got, &expected, sizeof(mien_result)), 0) << "seed " << seed;
    face_frames += expected.face_frames;
  }
  EXPECT_GT(face_frames, kInterleavings) << "the test must track faces";
}

}  // namespace
}  // namespace mien::tests
