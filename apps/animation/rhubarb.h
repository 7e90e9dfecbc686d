// Mouth cues of Rhubarb Lip Sync: the times at which each of nine mouth shapes starts. Forms are
// TSV ("0.00\tX", the last line is the end of the audio), JSON, XML, and switch data of Moho and
// OpenToonz (.dat: "1 X", frames from 1 on, 24 per second as Rhubarb's default).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/writer.h"

namespace mien::animation {

enum class RhubarbForm : std::uint8_t { kTsv, kJson, kXml, kDat };

// Uses the shapes of the frames if they have any, else the shape of the strongest viseme
// (visemes.h). Shapes from visemes that are shorter than 0.08 s are merged into the
// previous one. Cues count from the start of the audio at 0, or from the start of the clip if it is
// earlier. JSON and XML contain `audio_file`.
[[nodiscard]] std::unique_ptr<AnimationWriter> rhubarb_writer(RhubarbForm form,
                                                              const std::string& audio_file);

// Reads one frame per cue, held until the next; the last one, an X, is the end of the audio. The
// text determines the form; a .dat may also have Preston Blair's names. Leaves `clip` unchanged on
// failure.
[[nodiscard]] bool read_rhubarb(std::string_view text, Clip& clip, Fault& fault);

}  // namespace mien::animation
