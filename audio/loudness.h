// The running level of audio, which makes log-mel energies independent of the distance to the
// microphone.
#pragma once

#include <cstddef>
#include <span>

#include "audio/mfcc.h"

namespace mien::audio {

class Loudness {
 public:
  // Approximate time constants of the level, in windows.
  static constexpr float kAttack = 4.0f;
  static constexpr float kRelease = 200.0f;

  // Returns to the level of silence.
  void reset();

  // Adds a window and writes its energies, relative to the level, as the jaw decoder expects them.
  void subtract(std::span<const float, kBands> log_mel, std::span<float, kBands> relative);

 private:
  float level_ = 0.0f;
};

}  // namespace mien::audio
