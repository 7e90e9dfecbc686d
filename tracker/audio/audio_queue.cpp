// The lock-free audio queue.
#include "tracker/audio/audio_queue.h"

#include <bit>
#include <limits>
#include <new>

namespace mien::tracker {
namespace {

// With shorter blocks on average, the ring of blocks fills before that of samples.
constexpr std::uint32_t kSamplesPerBlock = 32;
constexpr std::uint32_t kMinBlocks = 64;

template <typename T>
std::span<T> take(engine::Arena& arena, std::uint32_t count) {
  const std::span<std::byte> memory = arena.take(sizeof(T) * count);
  return memory.empty() ? std::span<T>() : std::span(new (memory.data()) T[count](), count);
}

std::size_t at(std::uint32_t position, std::size_t size) { return position & (size - 1); }

}  // namespace

void AudioQueue::load(std::int32_t samples, engine::Arena& arena) {
  if (samples <= 0) {
    return;
  }
  const std::uint32_t capacity = std::bit_ceil(static_cast<std::uint32_t>(samples));
  samples_ = take<float>(arena, capacity);
  blocks_ = take<Block>(arena, std::max(kMinBlocks, capacity / kSamplesPerBlock));
}

bool AudioQueue::place(std::uint32_t frames, std::uint32_t& first) const {
  const auto capacity = static_cast<std::uint32_t>(samples_.size());
  const std::uint32_t to_end = capacity - (samples_written_ & (capacity - 1));
  first = frames <= to_end ? samples_written_ : samples_written_ + to_end;
  const std::uint32_t used = first + frames - samples_read_.load(std::memory_order_acquire);
  return used <= capacity;
}

bool AudioQueue::push(const AudioView& view, std::int64_t pts_ns) {
  if (view.pcm.frames == 0) {
    return true;
  }
  const std::uint32_t written = blocks_written_.load(std::memory_order_relaxed);
  const std::uint32_t waiting = written - blocks_read_.load(std::memory_order_acquire);
  if (view.pcm.frames > samples_.size() || waiting == blocks_.size()) {
    return false;
  }
  const auto frames = static_cast<std::uint32_t>(view.pcm.frames);
  std::uint32_t first = 0;
  if (!place(frames, first)) {
    return false;
  }
  audio::to_mono(view.pcm, 0, samples_.subspan(at(first, samples_.size()), frames));
  blocks_[at(written, blocks_.size())] = {pts_ns, view.rate, first, frames};
  samples_written_ = first + frames;
  blocks_written_.store(written + 1, std::memory_order_release);
  return true;
}

bool AudioQueue::empty() const {
  return blocks_read_.load(std::memory_order_relaxed) ==
         blocks_written_.load(std::memory_order_acquire);
}

bool AudioQueue::front(Block& block, audio::Pcm& samples) const {
  if (empty()) {
    return false;
  }
  block = blocks_[at(blocks_read_.load(std::memory_order_relaxed), blocks_.size())];
  samples = {audio::SampleFormat::kFloat32, false, 1, block.frames, {}};
  samples.channel[0] = &samples_[at(block.first, samples_.size())];
  return true;
}

void AudioQueue::pop(const Block& block) {
  samples_read_.store(block.first + block.frames, std::memory_order_release);
  blocks_read_.store(blocks_read_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

}  // namespace mien::tracker
