// An animated face in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/animation/fault.h"
#include "formats/animation/frame.h"
#include "formats/animation/frame_sequence.h"

namespace mien::formats {

struct Clip {
  FrameSequence frames;            // times do not go back
  std::string audio_file;          // where the format knows one
  std::int64_t out_of_range = 0;   // values of the file beyond 0..1, brought to the nearest of them
  std::vector<std::string> notes;  // what was taken for granted, and the option that changes it
};

// How much memory the frames of a file may take: no reader takes more than 8 times its input and
// 64 MB. Files whose lines have something to say stay far below.
[[nodiscard]] std::size_t most_clip_bytes(std::size_t input_bytes);

// False, with a fault, where that is too little for one frame more.
[[nodiscard]] bool add_frame(Clip& clip, const Frame& frame, std::size_t line, Fault& fault);

// Of the times of a clip: from its first to its last frame, divided by how many steps lie between;
// 1/30 s where there are none.
[[nodiscard]] double mean_step_s(const FrameSequence& frames);
[[nodiscard]] double mean_step_s(std::int64_t first_ns, std::int64_t last_ns, std::size_t frames);

// Whether each frame lies within half a millisecond of where even steps would put it.
[[nodiscard]] bool evenly_spaced(const FrameSequence& frames);

}  // namespace mien::formats
