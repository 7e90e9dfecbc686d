// An animated face in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/animation/fault.h"
#include "apps/animation/frame.h"
#include "apps/animation/frame_sequence.h"

namespace mien::animation {

struct Clip {
  FrameSequence frames;            // times do not decrease
  std::string audio_file;          // if the format has it
  std::int64_t out_of_range = 0;   // number of values clamped to 0..1
  std::vector<std::string> notes;  // assumptions, with the option that changes them
};

// Limits the memory of the frames of a file: no reader uses more than 8 times its input and 64 MB.
// Typical files stay far below.
[[nodiscard]] std::size_t max_clip_bytes(std::size_t input_bytes);

// Returns false with a fault if the limit would be exceeded.
[[nodiscard]] bool add_frame(Clip& clip, const Frame& frame, std::size_t line, Fault& fault);

// The time from the first to the last frame, divided by the number of steps; 1/30 s without steps.
[[nodiscard]] double mean_step_s(const FrameSequence& frames);
[[nodiscard]] double mean_step_s(std::int64_t first_ns, std::int64_t last_ns, std::size_t frames);

// Whether each frame is within half a millisecond of its even time.
[[nodiscard]] bool evenly_spaced(const FrameSequence& frames);

}  // namespace mien::animation
