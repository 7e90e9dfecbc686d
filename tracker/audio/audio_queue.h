// Passes audio from one thread to another. Wait-free for one writer and one reader.
#pragma once

#include <mien/mien.h>

#include <atomic>
#include <cstdint>
#include <span>

#include "audio/pcm.h"
#include "engine/arena.h"
#include "tracker/audio/audio_view.h"

namespace mien::tracker {

// Two rings: samples, and blocks that refer to them. The samples of a block are contiguous: if they
// do not fit before the end of the ring, they start at its beginning. Positions increase without
// limit and are wrapped when used. A store to `blocks_written_` publishes a block; stores to
// `samples_read_` and `blocks_read_` free its memory.
class AudioQueue {
 public:
  static constexpr std::int32_t kMaxSamples = 1 << 22;

  struct Block {
    std::int64_t pts_ns = 0;
    std::int32_t rate = 0;
    std::uint32_t first = 0;  // position of the first sample
    std::uint32_t frames = 0;
  };

  // Takes memory for `samples` samples from `arena`. With 0 every push fails.
  void load(std::int32_t samples, engine::Arena& arena);

  // For the writing thread. False, without any effect, if the queue is full.
  [[nodiscard]] bool push(const AudioView& view, std::int64_t pts_ns);

  // For the reading thread: the oldest block, with its samples as one channel of floats that stay
  // valid until `pop`; false if the queue is empty.
  [[nodiscard]] bool front(Block& block, audio::Pcm& samples) const;
  void pop(const Block& block);
  [[nodiscard]] bool empty() const;

 private:
  // Finds the position of `frames` new samples, at or after `samples_written_`; false if they do
  // not fit.
  [[nodiscard]] bool place(std::uint32_t frames, std::uint32_t& first) const;

  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

  std::span<float> samples_;  // the sizes of both rings are powers of two
  std::span<Block> blocks_;
  std::uint32_t samples_written_ = 0;  // used by the writing thread only
  std::atomic<std::uint32_t> blocks_written_ = 0;
  std::atomic<std::uint32_t> blocks_read_ = 0;
  std::atomic<std::uint32_t> samples_read_ = 0;
};

}  // namespace mien::tracker
