// Mixes controls from audio and video outside the tracker, as mien_tracker_push_audio describes it.
#pragma once

#include <array>
#include <mien/mien.hpp>

#include "apps/mien/networks/model_files.h"

namespace mien::app {

class AudioMix {
 public:
  // Without weights for audio, `controls` returns those from video.
  AudioMix() = default;
  // Throws Failure.
  explicit AudioMix(const Blob& audionet);

  // `from_video`: a face, from video. `from_audio`: the same frame without a face, from audio, and
  // the controls that still fade out of a lost face, `fading`.
  [[nodiscard]] std::array<float, MIEN_CONTROL_COUNT> controls(
      const Result& from_video, const Result& from_audio,
      const std::array<float, MIEN_CONTROL_COUNT>& fading) const;

 private:
  std::array<float, MIEN_CONTROL_COUNT> audio_ = {};
  std::array<float, MIEN_CONTROL_COUNT> video_ = {};
};

}  // namespace mien::app
