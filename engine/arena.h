// Hands out pieces of one block of memory. Without a block it only adds up what would be needed:
// the same code measures and lays out.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace mien::engine {

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  struct Need {
    std::size_t own_bytes = 0;     // of all pieces taken
    std::size_t shared_bytes = 0;  // of the largest piece shared
    [[nodiscard]] std::size_t total_bytes() const { return own_bytes + shared_bytes; }
  };

  Arena() = default;  // measures

  // `memory` has at least need.total_bytes() and is kAlignment-aligned.
  Arena(std::byte* memory, const Need& need) : memory_(memory), room_(need) {}

  [[nodiscard]] bool measuring() const { return memory_ == nullptr; }
  [[nodiscard]] const Need& need() const { return need_; }

  // `bytes` bytes, kAlignment-aligned; nothing when measuring or when there is no room left.
  [[nodiscard]] std::span<std::byte> take(std::size_t bytes) {
    const std::size_t offset = need_.own_bytes;
    need_.own_bytes += aligned(bytes);
    return piece(offset, bytes, need_.own_bytes <= room_.own_bytes);
  }

  // The same bytes for everybody who asks.
  [[nodiscard]] std::span<std::byte> share(std::size_t bytes) {
    need_.shared_bytes = std::max(need_.shared_bytes, aligned(bytes));
    return piece(room_.own_bytes, bytes, need_.shared_bytes <= room_.shared_bytes);
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
  Need room_;
  Need need_;
};

}  // namespace mien::engine
