// Mixes controls predicted from video and audio (Navarro et al. 2023, section 5).
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>
#include <span>

#include "engine/model.h"
#include "tracker/decoders/controls.h"

namespace mien::tracker {

using Controls = std::array<float, kControls>;

// The prediction from audio for one frame.
struct AudioOutput {
  Controls controls = {};  // 0 where audio predicts nothing
  float alpha = 0.0f;      // 0..1, mien_result.voice_activity
};

// Mixed control = (1 - alpha) v + alpha (w_a a + w_v v), with v from video and a from audio. Where
// video predicts nothing, w_a is 1 and w_v is 0.
class Mixer {
 public:
  // Reads the weights from a model file. Audio drives the controls with w_a > 0.
  [[nodiscard]] mien_status load(const engine::Model& model);

  // False unless both are in 0..1.
  [[nodiscard]] bool set_weights(std::size_t control, float audio, float video);
  // Restores the weights of the model file.
  void restore() { weights_ = loaded_; }

  // Bit i: audio drives control i.
  [[nodiscard]] std::uint64_t driven() const;

  // Mixes the prediction from audio into `controls`, which come from video. `video_weights`, 0..1:
  // how much video predicts each control.
  void mix(const AudioOutput& output, std::span<const float, kControls> video_weights,
           std::span<float, kControls> controls) const;

 private:
  struct Weights {
    Controls audio = {};
    Controls video = {};
  };

  Weights loaded_;
  Weights weights_;
};

}  // namespace mien::tracker
