// JSON lines: one object per frame with all data of a Frame; docs/cli.md describes it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/writer.h"

namespace mien::animation {

// One object without a line feed, also used for network packets.
[[nodiscard]] std::string frame_json(const Frame& frame);

[[nodiscard]] std::unique_ptr<AnimationWriter> frames_jsonl_writer();

// Every object must have t_ns; unknown keys are ignored. Leaves `clip` unchanged on failure.
[[nodiscard]] bool read_frames_jsonl(std::string_view text, Clip& clip, Fault& fault);

}  // namespace mien::animation
