// Where the intermediate maps of a network lie in one arena: maps that are never alive together may
// share it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/mien_format.h"

namespace mien::engine {

inline constexpr std::size_t kArenaAlignment = 64;

[[nodiscard]] constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
}

// Places one map after another, each as low as those still alive allow.
class ArenaPlan {
 public:
  // The offset, a multiple of kArenaAlignment, of a map that is written at step `born` and read for
  // the last time at step `dies` (>= born). `born` never descends; at most kMaxLayers calls.
  std::size_t place(std::size_t bytes, std::uint32_t born, std::uint32_t dies);

  // Of the arena, a multiple of kArenaAlignment.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Map {
    std::size_t begin, end;
    std::uint32_t dies;
  };

  void drop_expired(std::uint32_t now);
  [[nodiscard]] std::uint32_t lowest_gap(std::size_t bytes, std::size_t& begin) const;

  Map live_[formats::kMaxLayers];  // by offset
  std::uint32_t count_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace mien::engine
