// Sound from one thread to another: wait-free on both sides, one of either.
#pragma once

#include <mien/mien.h>

#include <atomic>
#include <cstdint>
#include <span>

#include "audio/pcm.h"
#include "engine/arena.h"
#include "tracker/audio/audio_view.h"

namespace mien::tracker {

// Two rings, of samples and of blocks that say which samples are theirs. A block lies in one piece,
// so that what would not fit before the end of the ring begins at its beginning. Positions count on
// and are wrapped where they are used; what is written becomes visible with `blocks_written_`, what
// is read becomes free with `blocks_read_` and `samples_read_`.
class AudioQueue {
 public:
  static constexpr std::int32_t kMaxSamples = 1 << 22;

  struct Block {
    std::int64_t pts_ns = 0;
    std::int32_t rate = 0;
    std::uint32_t first = 0;  // position of its samples
    std::uint32_t frames = 0;
  };

  // Takes from `arena` room for so many samples; 0: none, and nothing fits.
  void load(std::int32_t samples, engine::Arena& arena);

  // By the one thread that has the sound. False, and nothing is taken, when there is no room.
  [[nodiscard]] bool push(const AudioView& sound, std::int64_t pts_ns);

  // By the one thread that hears it: the oldest block, its samples in one channel of floats; false
  // when there is none. They stay there until `pop`.
  [[nodiscard]] bool front(Block& block, audio::Pcm& samples) const;
  void pop(const Block& block);
  [[nodiscard]] bool empty() const;

 private:
  // Where `frames` samples go, beginning at `samples_written_`; false when they do not fit.
  [[nodiscard]] bool place(std::uint32_t frames, std::uint32_t& first) const;

  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

  std::span<float> samples_;  // a power of two of them, as of blocks
  std::span<Block> blocks_;
  std::uint32_t samples_written_ = 0;  // of the writing thread alone
  std::atomic<std::uint32_t> blocks_written_ = 0;
  std::atomic<std::uint32_t> blocks_read_ = 0;
  std::atomic<std::uint32_t> samples_read_ = 0;
};

}  // namespace mien::tracker
