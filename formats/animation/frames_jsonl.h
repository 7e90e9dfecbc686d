// JSON lines: one object a frame, which holds everything a Frame does; docs/cli.md describes it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/writer.h"

namespace mien::formats {

// One object without a line feed: also what a network sender puts into a packet.
[[nodiscard]] std::string frame_json(const Frame& frame);

[[nodiscard]] std::unique_ptr<AnimationWriter> frames_jsonl_writer();

// t_ns has to be in every object; unknown keys are passed over. On a fault `clip` stays as it was.
[[nodiscard]] bool read_frames_jsonl(std::string_view text, Clip& clip, Fault& fault);

}  // namespace mien::formats
