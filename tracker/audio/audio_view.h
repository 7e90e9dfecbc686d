// The caller's sound as the tracker hears it.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "audio/pcm.h"

namespace mien::tracker {

struct AudioView {
  audio::Pcm pcm = {};
  std::int32_t rate = 0;  // samples a second
};

// Checks `given` completely, but for the samples themselves.
[[nodiscard]] mien_status view_audio(const mien_audio* given, AudioView& view);

}  // namespace mien::tracker
