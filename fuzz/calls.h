// A tracker for targets, and a check of its results.
#pragma once

#include <mien/mien.h>

#include <cstdint>

namespace mien::fuzz {

// Uses test networks that detect bright discs and convert loudness to controls. Supports all
// levels. Never fails.
[[nodiscard]] mien_tracker* make_tracker(std::int32_t max_faces = 1);

// Stops the program if a value is not finite or is out of range.
void require_valid(const mien_result& result);

}  // namespace mien::fuzz
