// Tests with an audio thread beside a video thread, and with trackers on several threads. The
// thread sanitizer runs them as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "engine/arena.h"
#include "tests/tracker/blob_tracker.h"
#include "tracker/audio/audio_queue.h"

namespace mien::tests {
namespace {

constexpr int kRate = 16000;
constexpr int kSeconds = 4;

std::vector<float> noise() {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> amplitude(-0.5f, 0.5f);
  std::vector<float> samples(std::size_t{kRate} * kSeconds);
  std::generate(samples.begin(), samples.end(), [&] { return amplitude(engine); });
  return samples;
}

Audio block_of(const std::vector<float>& samples, std::size_t first, std::size_t count) {
  Audio audio;
  audio.sample_rate = kRate;
  audio.frames = std::min(count, samples.size() - first);
  audio.samples[0] = samples.data() + first;
  return audio;
}

std::int64_t time_ns(std::size_t sample) {
  return static_cast<std::int64_t>(sample) * 1'000'000'000 / kRate;
}

BlobTracker with_queue(std::int32_t samples) {
  return BlobTracker({},
                     [=](mien_tracker_config& config) { config.audio_queue_samples = samples; });
}

TEST(AudioQueue, GivesTheSameResultAsPushAudio) {
  const std::vector<float> samples = noise();
  BlobTracker queued = with_queue(8192), pushed = with_queue(0);
  std::size_t first = 0, blocks = 0;
  for (std::size_t size = 1; first < samples.size(); size = size % 700 + 37) {
    const Audio block = block_of(samples, first, size);
    ASSERT_EQ(queued.tracker().queue_audio(block, time_ns(first)), MIEN_OK);
    ASSERT_EQ(pushed.tracker().push_audio(block, time_ns(first)), MIEN_OK);
    first += block.frames;
    if (++blocks % 3 == 0) {
      const Result a = queued.advance(), b = pushed.advance();
      ASSERT_EQ(std::memcmp(&a, &b, sizeof(mien_result)), 0) << "after " << first;
    }
  }
  const Result result = queued.advance();
  EXPECT_GT(result.voice_activity, 0.0f);
}

TEST(AudioQueue, ReportsWhenItIsFull) {
  const std::vector<float> samples = noise();
  BlobTracker tracker = with_queue(1000);  // 1024
  EXPECT_EQ(tracker.tracker().queue_audio(block_of(samples, 0, 1025), 0),
            MIEN_ERROR_AUDIO_QUEUE_FULL);
  EXPECT_EQ(tracker.tracker().queue_audio(block_of(samples, 0, 1024), 0), MIEN_OK);
  EXPECT_EQ(tracker.tracker().queue_audio(block_of(samples, 0, 1), 0), MIEN_ERROR_AUDIO_QUEUE_FULL);
  (void)tracker.advance();
  int blocks = 0;
  while (tracker.tracker().queue_audio(block_of(samples, 0, 1), 0) == MIEN_OK) {
    ++blocks;
  }
  EXPECT_EQ(blocks, 64);
  (void)tracker.advance();
  for (int i = 0; i < 100;
       ++i) {  // half of the capacity always fits, wherever the last block ended
    ASSERT_EQ(
        tracker.tracker().queue_audio(block_of(samples, 0, static_cast<std::size_t>(412 + i)), 0),
        MIEN_OK);
    (void)tracker.advance();
  }
}

TEST(AudioQueue, BlocksAreContiguousInTheRing) {
  constexpr std::int32_t kCapacity = 64;
  tracker::AudioQueue queue;
  engine::Arena measure;
  queue.load(kCapacity, measure);
  alignas(engine::Arena::kAlignment) std::byte memory[8192];
  ASSERT_LE(measure.need().total_bytes(), sizeof memory);
  engine::Arena arena(memory, measure.need());
  queue.load(kCapacity, arena);
  const std::vector<float> samples = noise();
  const void* ring = nullptr;
  std::uint32_t next = 0;
  for (std::uint32_t frames :
       {16u, 16u, 16u, 17u, 47u, 30u, 30u, 5u}) {  // up to the end, and one beyond
    tracker::AudioView sound;
    sound.rate = kRate;
    sound.pcm = {audio::SampleFormat::kFloat32, false, 1, frames, {samples.data()}};
    ASSERT_TRUE(queue.push(sound, 0));
    tracker::AudioQueue::Block block;
    audio::Pcm output;
    ASSERT_TRUE(queue.front(block, output));
    ring = ring == nullptr ? output.channel[0] : ring;
    const auto begin = static_cast<std::uint32_t>(static_cast<const float*>(output.channel[0]) -
                                                  static_cast<const float*>(ring));
    EXPECT_EQ(begin, next + frames <= kCapacity ? next : 0u) << frames;
    next = (begin + frames) % kCapacity;
    queue.pop(block);
  }
}

TEST(AudioQueue, ExistsOnlyIfConfigured) {
  const std::vector<float> samples = noise();
  BlobTracker none = with_queue(0);
  EXPECT_EQ(none.tracker().queue_audio(block_of(samples, 0, 1), 0), MIEN_ERROR_AUDIO_QUEUE_FULL);
  BlobTracker without_audio({}, [](mien_tracker_config& config) {
    config.audio = 0;
    config.audio_queue_samples = 1000;
  });
  EXPECT_EQ(without_audio.tracker().queue_audio(block_of(samples, 0, 1), 0),
            MIEN_ERROR_NO_AUDIONET);
  Audio wrong = block_of(samples, 0, 1);
  wrong.sample_rate = 1;
  EXPECT_EQ(with_queue(100).tracker().queue_audio(wrong, 0), MIEN_ERROR_AUDIO_RATE);
  EXPECT_EQ(mien_tracker_queue_audio(nullptr, &wrong, 0), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(AudioQueue, ResetDiscardsQueuedAudio) {
  const std::vector<float> samples = noise();
  BlobTracker tracker = with_queue(16384);
  ASSERT_EQ(tracker.tracker().queue_audio(block_of(samples, 0, 16000), 0), MIEN_OK);
  ASSERT_EQ(tracker.tracker().reset(), MIEN_OK);
  EXPECT_EQ(tracker.advance().voice_activity, 0.0f);
}

TEST(AudioQueue, RejectsCapacityOutOfRange) {
  const AlignedBytes basenet = blob_basenet(), proposal = blob_proposal();
  BlobConfig config = blob_config(basenet, proposal);
  for (const std::int32_t samples : {-1, (1 << 22) + 1}) {
    config.audio_queue_samples = samples;
    Tracker tracker;
    EXPECT_EQ(tracker.create(config), MIEN_ERROR_OUT_OF_RANGE);
  }
}

// The final result equals that of one thread: no sample is lost, repeated or read before it is
// written.
TEST(AudioQueue, WorksBetweenTwoThreads) {
  const std::vector<float> samples = noise();
  BlobTracker tracker = with_queue(4096), alone = with_queue(0);
  std::atomic<bool> done = false;
  std::thread microphone([&] {
    for (std::size_t first = 0; first < samples.size(); first += 128) {
      while (tracker.tracker().queue_audio(block_of(samples, first, 128), time_ns(first)) !=
             MIEN_OK) {
        std::this_thread::yield();
      }
    }
    done = true;
  });
  const Buffer picture(disc_picture(160.0f, 120.0f, 70.0f), {});
  for (bool last = false; !last;) {
    last = done;
    (void)tracker.push(picture.image(), 0);
    if (!last && tracker.result().frames % 16 == 7) {
      EXPECT_EQ(tracker.tracker().set_lod(
                    static_cast<std::int32_t>(tracker.result().frames / 16 % 2) + 1),
                MIEN_OK);
    }
  }
  microphone.join();
  for (std::size_t first = 0; first < samples.size(); first += 128) {
    ASSERT_EQ(alone.tracker().push_audio(block_of(samples, first, 128), time_ns(first)), MIEN_OK);
  }
  // At a time far from earlier frames, both results depend only on the audio.
  const std::int64_t end_ns = kSeconds * 1'000'000'000LL - 100'000'000;
  for (BlobTracker* one : {&tracker, &alone}) {
    for (int i = 0; i < 90; ++i) {
      EXPECT_EQ(one->tracker().advance(end_ns), MIEN_OK);
    }
  }
  EXPECT_GT(alone.result().voice_activity, 0.1f);
  EXPECT_NEAR(tracker.result().voice_activity, alone.result().voice_activity, 1e-3f);
}

TEST(Trackers, AreIndependentAcrossThreads) {
  const Buffer picture(disc_picture(160.0f, 120.0f, 70.0f), {});
  std::vector<Result> results(4);
  std::vector<std::thread> threads;
  for (Result& result : results) {
    threads.emplace_back([&result, &picture] {
      BlobTracker tracker;
      for (int i = 0; i < 30; ++i) {
        result = tracker.push(picture.image());
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const Result& result : results) {
    EXPECT_TRUE(result.has_face());
    EXPECT_EQ(std::memcmp(&result, &results[0], sizeof(mien_result)), 0);
  }
}

}  // namespace
}  // namespace mien::tests
