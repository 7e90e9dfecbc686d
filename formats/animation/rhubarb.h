// Mouth cues as Rhubarb Lip Sync writes them: which of nine mouth shapes is seen from when on. As
// TSV ("0.00\tX", the last line says when the sound ends), JSON, XML, and as the switch data of
// Moho and OpenToonz (.dat: "1 X", frames from 1 on, 24 a second as Rhubarb has them by default).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/writer.h"

namespace mien::formats {

enum class RhubarbForm : std::uint8_t { kTsv, kJson, kXml, kDat };

// Shapes are those of the frames where they have some, else the shape of the strongest viseme
// (visemes.h); of the latter, none lasts less than 0.08 s: it goes to the one before.
// Cues count from the beginning of the sound, at 0; of a clip that begins before, from its own.
// `audio_file` is named in JSON and XML.
[[nodiscard]] std::unique_ptr<AnimationWriter> rhubarb_writer(RhubarbForm form,
                                                              const std::string& audio_file);

// A frame for each cue, which lasts until the next; the last one, an X, is where the sound ends.
// The form is seen from the text; a .dat may also have the names of Preston Blair's mouths. On a
// fault `clip` stays as it was.
[[nodiscard]] bool read_rhubarb(std::string_view text, Clip& clip, Fault& fault);

}  // namespace mien::formats
