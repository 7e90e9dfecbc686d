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

  // `from_video`: the result for a face on video. `from_audio`: the result for the same frame of a
  // tracker that found no face. `fading`: the part of its controls that fades out after a loss.
  [[nodiscard]] std::array<float, MIEN_CONTROL_COUNT> controls(
      const Result& from_video, const Result& from_audio,
      const std::array<float, MIEN_CONTROL_COUNT>& fading) const;

 private:
  std::array<float, MIEN_CONTROL_COUNT> audio_ = {};
  std::array<float, MIEN_CONTROL_COUNT> video_ = {};
};

}  // namespace mien::app
