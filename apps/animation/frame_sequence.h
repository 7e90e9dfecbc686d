// Frames in little memory: each is stored as the difference to the previous one. A Frame has 700
// bytes, but a line of a file may have four.
//
// Frames can only be read in order; any number of iterators may be active.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "apps/animation/frame.h"

namespace mien::animation {

class FrameSequence {
 public:
  FrameSequence() = default;
  explicit FrameSequence(const std::vector<Frame>& frames);

  // Limits the memory of add(); unlimited by default.
  void limit_bytes(std::size_t max_bytes) { max_bytes_ = max_bytes; }

  // Returns false and adds nothing if the limit would be exceeded.
  [[nodiscard]] bool add(const Frame& frame);
  // The same for a sequence without a limit.
  void push_back(const Frame& frame) { static_cast<void>(add(frame)); }

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  // Requires a non-empty sequence.
  [[nodiscard]] std::int64_t first_time_ns() const { return first_time_ns_; }
  [[nodiscard]] std::int64_t last_time_ns() const { return last_.time_ns; }

  class Iterator;
  [[nodiscard]] Iterator begin() const;
  [[nodiscard]] static std::default_sentinel_t end() { return {}; }

  [[nodiscard]] std::vector<Frame> unpacked() const;

  // Visits all frames and frees their memory meanwhile. The sequence is empty afterwards.
  template <class Visit>
  void consume(Visit visit);

 private:
  // All numbers of a frame except number and time, in groups of 8.
  static constexpr std::size_t kGroups = 18;
  static constexpr std::size_t kSlots = 8 * kGroups;

  struct State {
    std::array<std::uint64_t, kSlots> slots{};
    std::int64_t number = -1;
    std::int64_t time_ns = 0;
  };

  static void put(const Frame& frame, State& state);
  static void take(const State& state, Frame& frame);
  static std::string packed(const State& before, const State& state);

  std::vector<std::string> blocks_;
  State last_;
  std::int64_t first_time_ns_ = 0;
  std::size_t size_ = 0;
  std::size_t bytes_ = 0;
  std::size_t max_bytes_ = std::numeric_limits<std::size_t>::max();
};

class FrameSequence::Iterator {
 public:
  using value_type = Frame;
  using difference_type = std::ptrdiff_t;

  Iterator() = default;
  explicit Iterator(const FrameSequence& frames) : frames_(&frames), left_(frames.size_) { read(); }

  // Valid until the next step.
  const Frame& operator*() const { return frame_; }
  const Frame* operator->() const { return &frame_; }
  Iterator& operator++() {
    --left_;
    read();
    return *this;
  }
  void operator++(int) { ++*this; }
  friend bool operator==(const Iterator& at, std::default_sentinel_t) { return at.left_ == 0; }

  // The number of blocks already read.
  [[nodiscard]] std::size_t block() const { return block_; }

 private:
  void read();
  std::uint64_t varint();
  std::uint64_t bytes(std::size_t count);

  const FrameSequence* frames_ = nullptr;
  std::size_t left_ = 0;
  std::size_t block_ = 0, at_ = 0;
  State state_;
  Frame frame_;
};

inline FrameSequence::Iterator FrameSequence::begin() const { return Iterator(*this); }

template <class Visit>
void FrameSequence::consume(Visit visit) {
  std::size_t freed = 0;
  for (Iterator at = begin(); at != end(); ++at) {
    visit(*at);
    for (; freed < at.block(); ++freed) {
      std::exchange(blocks_[freed], std::string());
    }
  }
  *this = FrameSequence();
}

}  // namespace mien::animation
