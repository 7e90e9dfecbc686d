// A tracker for targets, and what every answer of one has to be.
#pragma once

#include <mien/mien.h>

#include <cstdint>

namespace mien::fuzz {

// With networks that see bright discs and hear loudness; of all levels, for `max_faces`. Never
// fails.
[[nodiscard]] mien_tracker* make_tracker(std::int32_t max_faces = 1);

// Stops the program where a number is not finite or out of its range.
void require_sane(const mien_result& result);

}  // namespace mien::fuzz
