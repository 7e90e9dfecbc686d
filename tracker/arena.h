// Hands out pieces of one block of memory, in order. Without a block it only adds up what would be
// needed: the same code measures and lays out.
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <span>
#include <utility>

namespace mien::tracker {

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  Arena() = default;  // measures
  // `memory` is kAlignment-aligned.
  explicit Arena(std::span<std::byte> memory) : memory_(memory) {}

  [[nodiscard]] bool measuring() const { return memory_.data() == nullptr; }
  [[nodiscard]] std::size_t used_bytes() const { return used_bytes_; }

  // True as long as everything taken was there.
  [[nodiscard]] bool fits() const { return measuring() || used_bytes_ <= memory_.size(); }

  // `bytes` bytes, kAlignment-aligned, or nothing when measuring or when the block is used up.
  [[nodiscard]] std::span<std::byte> take(std::size_t bytes) {
    const std::size_t offset = used_bytes_;
    used_bytes_ += (bytes + kAlignment - 1) / kAlignment * kAlignment;
    return measuring() || !fits() ? std::span<std::byte>() : memory_.subspan(offset, bytes);
  }

  // `count` values of a trivial type, all zero.
  template <typename T>
  [[nodiscard]] std::span<T> take_array(std::size_t count) {
    const std::span<std::byte> bytes = take(count * sizeof(T));
    return bytes.empty() ? std::span<T>() : std::span<T>(new (bytes.data()) T[count](), count);
  }

 private:
  std::span<std::byte> memory_;
  std::size_t used_bytes_ = 0;
};

}  // namespace mien::tracker
