// Allocates ranges of one memory block in sequence. Without a block it only adds up the bytes, so
// that the same code measures and lays out.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace mien::engine {

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  struct Need {
    std::size_t own_bytes = 0;     // sum of all calls of take
    std::size_t shared_bytes = 0;  // maximum of all calls of share
    [[nodiscard]] std::size_t total_bytes() const { return own_bytes + shared_bytes; }
  };

  Arena() = default;  // only measures

  // `memory` must have need.total_bytes() bytes and be kAlignment-aligned.
  Arena(std::byte* memory, const Need& need) : memory_(memory), capacity_(need) {}

  [[nodiscard]] bool measuring() const { return memory_ == nullptr; }
  [[nodiscard]] const Need& need() const { return need_; }

  // A range of `bytes` bytes, kAlignment-aligned; empty when measuring or when the block is full.
  [[nodiscard]] std::span<std::byte> take(std::size_t bytes) {
    const std::size_t offset = need_.own_bytes;
    need_.own_bytes += aligned(bytes);
    return piece(offset, bytes, need_.own_bytes <= capacity_.own_bytes);
  }

  // Like take, but every call returns the same memory.
  [[nodiscard]] std::span<std::byte> share(std::size_t bytes) {
    need_.shared_bytes = std::max(need_.shared_bytes, aligned(bytes));
    return piece(capacity_.own_bytes, bytes, need_.shared_bytes <= capacity_.shared_bytes);
  }

 private:
  [[nodiscard]] static std::size_t aligned(std::size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }

  [[nodiscard]] std::span<std::byte> piece(std::size_t offset, std::size_t bytes, bool fits) const {
    return measuring() || !fits ? std::span<std::byte>()
                                : std::span<std::byte>(memory_ + offset, bytes);
  }

  std::byte* memory_ = nullptr;
  Need capacity_;
  Need need_;
};

}  // namespace mien::engine
