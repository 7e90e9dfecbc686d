// Picture and sound, mixed control by control (Navarro et al. 2023, section 5).
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>
#include <span>

#include "engine/model.h"
#include "tracker/decoders/controls.h"

namespace mien::tracker {

using Controls = std::array<float, kControls>;

// What is heard on one frame of output.
struct AudioOutput {
  Controls controls = {};  // 0 where sound says nothing
  float alpha = 0.0f;      // 0..1: how much the voice counts
};

// s = (1 - alpha) v + alpha (w_a a + w_v v) for the picture's v and the sound's a. Where the
// picture does not say anything, of a control or at all, the sound has its place: w_a is 1.
class Mixer {
 public:
  // The weights of a model file. Sound drives the controls that it gives a weight.
  [[nodiscard]] mien_status load(const engine::Model& model);

  // False unless both are in 0..1.
  [[nodiscard]] bool set_weights(std::size_t control, float audio, float video);
  // Those of the model file again.
  void restore() { weights_ = loaded_; }

  // Bit i: sound drives control i.
  [[nodiscard]] std::uint64_t driven() const;

  // Mixes what is heard into `controls`. `seen`, 0..1: how much the picture says of each.
  void mix(const AudioOutput& output, std::span<const float, kControls> seen,
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
