// Tests of audio in the tracker: validation, timing and mixing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tests/tracker/audio.h"
#include "tests/tracker/blob_tracker.h"
#include "tracker/decoders/controls.h"

namespace mien::tests {
namespace {

using tracker::control_named;

constexpr std::size_t kJawOpen = control_named("jawOpen");
constexpr float kLoud = 0.5f;

BlobTracker unsmoothed(const BlobOptions& options = {}) {
  return BlobTracker(options, [](mien_tracker_config& config) {
    config.smoothing = 0;
    config.voice_attack_ms = config.voice_release_ms = 0.0f;
  });
}

const Picture& disc() {
  static const Picture picture = disc_picture(160.0f, 120.0f, 70.0f);
  return picture;
}

TEST(AudioTrack, IsDisabledWithoutWeights) {
  BlobTracker blob({}, [](mien_tracker_config& config) { config.audio = 0; });
  const TestAudio sound = TestAudio().add(0.1, kLoud);
  EXPECT_EQ(blob.tracker().push_audio(sound.all(), 0), MIEN_ERROR_NO_AUDIONET);
  EXPECT_EQ(blob.tracker().set_audio_offset(0), MIEN_ERROR_NO_AUDIONET);
  EXPECT_EQ(blob.tracker().set_mix(0, 0.0f, 1.0f), MIEN_ERROR_NO_AUDIONET);
  EXPECT_EQ(blob.tracker().advance(0), MIEN_OK) << "a frame without an image is always possible";
}

TEST(AudioTrack, NeedsAudioNetAmongTheWeights) {
  Tracker tracker;
  ASSERT_EQ(tracker.create(blob_config(blob_basenet(), blob_proposal())), MIEN_OK);
  EXPECT_EQ(tracker.push_audio(TestAudio().add(0.1, kLoud).all(), 0), MIEN_ERROR_NO_AUDIONET);
}

TEST(AudioTrack, ReportsEachInvalidField) {
  BlobTracker blob;
  const TestAudio sound = TestAudio().add(0.1, kLoud);
  const auto status_with = [&](auto change) {
    Audio audio = sound.all();
    change(audio);
    return blob.tracker().push_audio(audio, 0);
  };
  EXPECT_EQ(status_with([](Audio&) {}), MIEN_OK);
  EXPECT_EQ(status_with([](Audio& a) { a.frames = 0; }), MIEN_OK);
  EXPECT_EQ(status_with([](Audio& a) { a.struct_size = 8; }), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(status_with([](Audio& a) { a.format = 2; }), MIEN_ERROR_AUDIO_FORMAT);
  for (const int rate : {0, -16000, 7999, 192001}) {
    EXPECT_EQ(status_with([=](Audio& a) { a.sample_rate = rate; }), MIEN_ERROR_AUDIO_RATE);
  }
  for (const int channels : {0, -1, 9, std::numeric_limits<int>::max()}) {
    EXPECT_EQ(status_with([=](Audio& a) { a.channels = channels; }), MIEN_ERROR_AUDIO_CHANNELS);
  }
  EXPECT_EQ(status_with([](Audio& a) { a.samples[0] = nullptr; }), MIEN_ERROR_AUDIO_SAMPLES);
  const auto second_channel_is_missing = [](Audio& a) { a.planar = 1, a.channels = 2; };
  EXPECT_EQ(status_with(second_channel_is_missing), MIEN_ERROR_AUDIO_SAMPLES);
  const auto odd_address = [](Audio& a) {
    a.samples[0] = static_cast<const std::byte*>(a.samples[0]) + 1;
    --a.frames;
  };
  EXPECT_EQ(status_with(odd_address), MIEN_ERROR_ALIGNMENT);
  EXPECT_EQ(mien_tracker_push_audio(nullptr, nullptr, 0), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_push_audio(blob.tracker().get(), nullptr, 0), MIEN_ERROR_NULL_ARGUMENT);
}

// Some microphones deliver empty blocks with arbitrary timestamps and rates.
TEST(AudioTrack, EmptyBlocksHaveNoEffect) {
  const auto empty_block = [](BlobTracker& blob, bool queued, std::int64_t pts_ns) {
    Audio empty;
    empty.sample_rate = 48000;
    const mien_status status = queued ? blob.tracker().queue_audio(empty, pts_ns)
                                      : blob.tracker().push_audio(empty, pts_ns);
    EXPECT_EQ(status, MIEN_OK);
  };
  const TestAudio sound = TestAudio().add(1.0, 0.05f);
  for (const bool queued : {false, true}) {
    BlobTracker plain = unsmoothed(), disturbed = unsmoothed();
    for (int frame = 0; frame < 30; ++frame) {
      empty_block(disturbed, queued, frame % 2 == 0 ? -1'000'000'000 : 1'000'000'000'000);
      if (frame == 10) {
        ASSERT_EQ(plain.tracker().push_audio(sound.all(), plain.now_ns()), MIEN_OK);
        ASSERT_EQ(disturbed.tracker().push_audio(sound.all(), plain.now_ns()), MIEN_OK);
      }
      const Result expected = plain.advance(), result = disturbed.advance();
      EXPECT_EQ(result.supported_controls, expected.supported_controls) << frame;
      EXPECT_EQ(result.voice_activity, expected.voice_activity) << frame;
      EXPECT_EQ(largest_step(result, expected), 0.0f) << frame;
    }
  }
}

TEST(AudioTrack, ValidatesMixingWeights) {
  BlobTracker blob;
  EXPECT_EQ(blob.tracker().set_mix(0, 1.0f, 0.0f), MIEN_OK);
  EXPECT_EQ(blob.tracker().set_mix(-1, 1.0f, 0.0f), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(blob.tracker().set_mix(MIEN_CONTROL_COUNT, 1.0f, 0.0f), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(blob.tracker().set_mix(0, 1.1f, 0.0f), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(blob.tracker().set_mix(0, 0.0f, std::nanf("")), MIEN_ERROR_OUT_OF_RANGE);
}

TEST(AudioTrack, MovesTheMouthWithoutVideo) {
  BlobTracker blob;
  EXPECT_EQ(blob.advance().voice_activity, 0.0f);
  const TestAudio sound = TestAudio().add(1.0, kLoud).add(1.0, 0.0f);
  ASSERT_EQ(blob.tracker().push_audio(sound.all(), blob.now_ns()), MIEN_OK);
  float loudest = 0.0f;
  Result result;
  for (int frame = 0; frame < 58; ++frame) {
    result = blob.advance();
    expect_valid(result);
    EXPECT_EQ(result.status, MIEN_FACE_SEARCHING);
    loudest = std::max(loudest, result.controls[kJawOpen]);
    EXPECT_EQ(result.controls[control_named("eyeBlinkLeft")], 0.0f)
        << "audio does not drive blinks";
  }
  EXPECT_GT(loudest, 0.95f);
  EXPECT_LT(result.controls[kJawOpen], 0.01f) << "after the end of speech";
  EXPECT_LT(result.voice_activity, 0.01f);
  EXPECT_TRUE(result.supports(static_cast<int>(kJawOpen)));
}

TEST(AudioTrack, SilenceDoesNotChangeVideoControls) {
  BlobTracker output, without_audio;
  const TestAudio silence = TestAudio().add(2.0, 0.0f);
  ASSERT_EQ(output.tracker().push_audio(silence.all(), 0), MIEN_OK);
  for (int frame = 0; frame < 50; ++frame) {
    const Result with = output.push(disc());
    const Result without = without_audio.push(disc());
    EXPECT_LT(largest_step(with, without), 0.002f) << frame;
    EXPECT_EQ(with.face_probability, without.face_probability);
  }
}

// Noise that is loud enough for speech, but does not saturate the controls.
TEST(AudioTrack, MixesAsDocumented) {
  BlobTracker both = unsmoothed(), video_only = unsmoothed(), output = unsmoothed();
  const TestAudio sound = TestAudio().add(3.5, 0.01f);
  ASSERT_EQ(both.tracker().push_audio(sound.all(), 0), MIEN_OK);
  ASSERT_EQ(output.tracker().push_audio(sound.all(), 0), MIEN_OK);
  Result mixed, picture, voice;
  for (int frame = 0; frame < 90; ++frame) {
    mixed = both.push(disc());
    picture = video_only.push(disc());
    voice = output.advance();
  }
  const float alpha = mixed.voice_activity;
  ASSERT_GT(alpha, 0.1f);
  ASSERT_LT(alpha, 0.999f);
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    const auto control = static_cast<std::size_t>(i);
    const float v = picture.controls[i];
    const float a = voice.controls[i] / alpha;  // without video the result is alpha * a
    const float w_a = control == kJawOpen ? kJawAudioWeight : kMouthAudioWeight;
    const bool audio_drives = voice.controls[i] != 0.0f || control == kJawOpen;
    const float expected =
        audio_drives ? (1 - alpha) * v + alpha * (w_a * a + kMouthVideoWeight * v) : v;
    EXPECT_NEAR(mixed.controls[i], std::clamp(expected, 0.0f, 1.0f), 2e-5f) << mien_control_name(i);
  }
}

TEST(AudioTrack, VoiceStrengthScalesControls) {
  const auto with_strength = [](float strength) {
    return [=](mien_tracker_config& config) {
      config.voice_strength = strength;
      config.smoothing = 0;
    };
  };
  BlobTracker plain({}, with_strength(1.0f)), half({}, with_strength(0.5f)),
      maximum({}, with_strength(4.0f));
  const TestAudio sound = TestAudio().add(1.5, 0.01f);
  Result unscaled, halved, scaled;
  for (BlobTracker* blob : {&plain, &half, &maximum}) {
    ASSERT_EQ(blob->tracker().push_audio(sound.all(), 0), MIEN_OK);
  }
  for (int frame = 0; frame < 40; ++frame) {
    unscaled = plain.advance();
    halved = half.advance();
    scaled = maximum.advance();
  }
  const float jaw = unscaled.controls[kJawOpen], alpha = unscaled.voice_activity;
  ASSERT_GT(jaw, 0.03f);
  EXPECT_NEAR(halved.controls[kJawOpen], 0.5f * jaw, 1e-3f);
  EXPECT_NEAR(scaled.controls[kJawOpen], std::min(4.0f * jaw, alpha), 1e-3f);
  const AlignedBytes basenet = blob_basenet(), proposal = blob_proposal();
  BlobConfig config = blob_config(basenet, proposal);
  for (const float refused : {-0.1f, 4.1f, std::nanf("")}) {
    config.voice_strength = refused;
    Tracker tracker;
    EXPECT_EQ(tracker.create(config), MIEN_ERROR_OUT_OF_RANGE) << refused;
  }
}

TEST(AudioTrack, SetMixChangesWeightsUntilReset) {
  BlobTracker blob = unsmoothed(), video_only = unsmoothed();
  ASSERT_EQ(blob.tracker().set_mix(static_cast<int>(kJawOpen), 0.0f, 1.0f), MIEN_OK);
  const TestAudio sound = TestAudio().add(1.5, kLoud);
  ASSERT_EQ(blob.tracker().push_audio(sound.all(), 0), MIEN_OK);
  for (int frame = 0; frame < 40; ++frame) {
    const float expected = video_only.push(disc()).controls[kJawOpen];
    EXPECT_EQ(blob.push(disc()).controls[kJawOpen], expected);
  }
  ASSERT_EQ(blob.tracker().reset(), MIEN_OK);
  ASSERT_EQ(blob.tracker().push_audio(sound.all(), blob.now_ns()), MIEN_OK);
  for (int frame = 0; frame < 30; ++frame) {
    (void)blob.advance();
  }
  EXPECT_GT(blob.result().controls[kJawOpen], 0.9f) << "the weights of the file";
}

// Number of frames until voice activity rises, for noise that starts at `begin_ns`.
int frames_until_active(BlobTracker& blob, std::int64_t begin_ns, std::int64_t offset_ns = 0) {
  const double lead = 0.5;
  const TestAudio sound = TestAudio().add(lead, 0.0f).add(1.0, kLoud);
  EXPECT_EQ(blob.tracker().set_audio_offset(offset_ns), MIEN_OK);
  EXPECT_EQ(
      blob.tracker().push_audio(sound.all(), begin_ns - static_cast<std::int64_t>(lead * 1e9)),
      MIEN_OK);
  for (int frame = 0; frame < 60; ++frame) {
    if (blob.advance().voice_activity > 0.5f) {
      return frame;
    }
  }
  return -1;
}

TEST(AudioTrack, ActsWithinAFrameOfItsTimestamp) {
  for (int later = 0; later < 10; ++later) {
    BlobTracker blob = unsmoothed();
    (void)blob.advance();
    const std::int64_t begin_ns = blob.now_ns() + kFrameNs + later * 7'000'000;
    const int frame = frames_until_active(blob, begin_ns);
    const double late = static_cast<double>(frame) - static_cast<double>(later) * 7.0 / 33.333;
    EXPECT_GE(late, -0.5) << later;
    EXPECT_LE(late, 1.0) << later;
  }
}

TEST(AudioTrack, OffsetDelaysAudio) {
  for (const int frames : {-6, 0, 6}) {
    BlobTracker blob = unsmoothed();
    (void)blob.advance();
    const std::int64_t begin_ns = blob.now_ns() + 10 * kFrameNs;
    EXPECT_NEAR(frames_until_active(blob, begin_ns, frames * kFrameNs), 9 + frames, 1) << frames;
  }
}

TEST(AudioTrack, ContinuesWithoutImages) {
  BlobTracker blob;
  const TestAudio sound = TestAudio().add(3.0, kLoud);
  ASSERT_EQ(blob.tracker().push_audio(sound.all(), 0), MIEN_OK);
  for (int frame = 0; frame < 20; ++frame) {
    (void)blob.push(disc());
  }
  EXPECT_EQ(blob.advance().status, MIEN_FACE_TRACKING) << "one miss does not lose the face";
  for (int frame = 0; frame < 40; ++frame) {
    expect_valid(blob.advance());
  }
  EXPECT_EQ(blob.result().status, MIEN_FACE_LOST);
  EXPECT_GT(blob.result().controls[kJawOpen], 0.9f);
  EXPECT_EQ(blob.push_until_found(disc()).status, MIEN_FACE_TRACKING);
}

// Results of every frame without video, with audio in blocks of `next_size()` samples.
template <class NextSize>
std::vector<Result> animation(const TestAudio& sound, NextSize next_size) {
  BlobTracker blob;
  std::size_t pushed = 0;
  std::vector<Result> results;
  for (int frame = 0; frame < 40; ++frame) {
    while (pushed < sound.size() && sound.time_ns(pushed) < blob.now_ns() + 200'000'000) {
      const Audio block = sound.block(pushed, next_size());
      EXPECT_EQ(blob.tracker().push_audio(block, sound.time_ns(pushed)), MIEN_OK);
      pushed += block.frames;
    }
    results.push_back(blob.advance());
  }
  return results;
}

TEST(AudioTrack, ResultsDoNotDependOnBlockSize) {
  for (const int rate : {8000, 16000, 44100, 48000}) {
    const TestAudio sound = TestAudio(rate).add(0.3, kLoud).add(0.3, 0.0f).add(1.0, 0.01f);
    const auto whole = animation(sound, [&] { return sound.size(); });
    std::mt19937 engine(9);
    const auto chunked = animation(sound, [&] { return 1 + engine() % 3000; });
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(std::memcmp(whole[i].controls, chunked[i].controls, sizeof whole[i].controls), 0);
      EXPECT_EQ(whole[i].voice_activity, chunked[i].voice_activity);
    }
  }
}

TEST(AudioTrack, ResetRestoresTheInitialState) {
  BlobTracker used, fresh;
  const TestAudio sound = TestAudio().add(1.0, kLoud);
  const Buffer image(disc(), {});
  for (int frame = 0; frame < 20; ++frame) {
    ASSERT_EQ(used.tracker().push_audio(sound.block(0, 600), frame * kFrameNs), MIEN_OK);
    (void)used.push(image.image(), frame * kFrameNs);
  }
  ASSERT_EQ(used.tracker().set_audio_offset(kFrameNs), MIEN_OK);
  ASSERT_EQ(used.tracker().reset(), MIEN_OK);
  for (BlobTracker* blob : {&used, &fresh}) {
    ASSERT_EQ(blob->tracker().push_audio(sound.all(), 0), MIEN_OK);
  }
  for (int frame = 0; frame < 30; ++frame) {
    const Result a = used.push(image.image(), frame * kFrameNs);
    const Result b = fresh.push(image.image(), frame * kFrameNs);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof(mien_result)), 0) << frame;
  }
}

TEST(AudioTrack, ResetDiscardsEarlierAudio) {
  BlobTracker blob = unsmoothed();
  ASSERT_EQ(blob.tracker().push_audio(TestAudio().add(1.0, kLoud).all(), 0), MIEN_OK);
  for (int frame = 0; frame < 15; ++frame) {
    (void)blob.advance();
  }
  ASSERT_GT(blob.result().voice_activity, 0.5f);
  ASSERT_EQ(blob.tracker().reset(), MIEN_OK);
  EXPECT_EQ(blob.advance().voice_activity, 0.0f);
}

TEST(AudioTrack, AcceptsAnySamplesAndTimestamps) {
  BlobTracker blob;
  std::mt19937 engine(5);
  std::vector<float> samples(4000);
  const float wild[] = {0.0f, 1.0f, -1.0f, 1e30f, std::nanf(""), INFINITY, -INFINITY, 1e-42f};
  const std::int64_t times[] = {0,
                                -1,
                                kFrameNs,
                                std::numeric_limits<std::int64_t>::max(),
                                std::numeric_limits<std::int64_t>::min(),
                                3'600'000'000'000};
  for (int i = 0; i < 300; ++i) {
    for (float& sample : samples) {
      sample = wild[engine() % std::size(wild)];
    }
    Audio audio;
    audio.sample_rate = std::vector<int>{8000, 16000, 44100, 192000}[engine() % 4];
    audio.channels = 1 + static_cast<int>(engine() % 8);
    audio.format = static_cast<int>(engine() % 2);
    audio.frames = engine() % (samples.size() / 8);
    audio.samples[0] = samples.data();
    ASSERT_EQ(blob.tracker().push_audio(audio, times[engine() % std::size(times)]), MIEN_OK);
    expect_valid(i % 3 == 0 ? blob.push(disc()) : blob.advance());
  }
}

}  // namespace
}  // namespace mien::tests
