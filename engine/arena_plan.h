// Where the intermediate maps of a network lie in one arena: maps that are never alive together may
// share it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/mien_format.h"

namespace mien::engine {

inline constexpr std::size_t kArenaAlignment = 64;

// A map that is written at step `born` and read for the last time at step `dies` (>= born).
struct Interval {
  std::size_t bytes = 0;
  std::uint32_t born = 0;
  std::uint32_t dies = 0;
  std::size_t offset = 0;  // result
};

// Places intervals [count], ordered by `born`, at the lowest free offset each; returns the arena's
// bytes.
std::size_t place(Interval* intervals, std::uint32_t count);

}  // namespace mien::engine
