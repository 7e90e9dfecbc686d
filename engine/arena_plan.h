// Places the intermediate maps of a network in one arena. Maps whose lifetimes do not overlap may
// share memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/mien_format.h"

namespace mien::engine {

inline constexpr std::size_t kArenaAlignment = 64;

[[nodiscard]] constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
}

// Places maps one by one, each at the lowest offset that is free during its lifetime.
class ArenaPlan {
 public:
  // Returns the offset, a multiple of kArenaAlignment, of a map that step `first_step` writes and
  // step `last_step` (>= first_step) reads last. `first_step` must not decrease; at most kMaxLayers
  // calls.
  std::size_t place(std::size_t bytes, std::uint32_t first_step, std::uint32_t last_step);

  // Size of the arena, a multiple of kArenaAlignment.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Map {
    std::size_t begin, end;
    std::uint32_t last_step;
  };

  void drop_expired(std::uint32_t now);
  [[nodiscard]] std::uint32_t lowest_gap(std::size_t bytes, std::size_t& begin) const;

  Map live_[formats::kMaxLayers];  // sorted by offset
  std::uint32_t count_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace mien::engine
