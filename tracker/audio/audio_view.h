// A validated view of the caller's audio block.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "audio/pcm.h"

namespace mien::tracker {

struct AudioView {
  audio::Pcm pcm = {};
  std::int32_t rate = 0;  // Hz
};

// Validates everything in `given` except the values of the samples.
[[nodiscard]] mien_status view_audio(const mien_audio* given, AudioView& view);

}  // namespace mien::tracker
