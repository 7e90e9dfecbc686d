// AudioNet: what is heard, step by step, to the controls of speech and to voice activity (Navarro
// et al. 2023, section 4). A step is 16 ms.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "audio/front_end.h"
#include "engine/arena.h"
#include "engine/model.h"
#include "engine/network.h"

namespace mien::audio {

inline constexpr std::size_t kSpeechControls = 18;

// What a voice does at one time.
struct Speech {
  // 0..1: jawOpen, jawForward, mouthClose, mouthFunnel, mouthPucker, mouthRollLower,
  // mouthRollUpper, mouthShrugLower, mouthShrugUpper, mouthPressLeft, mouthPressRight,
  // mouthStretchLeft, mouthStretchRight, mouthLowerDownLeft, mouthLowerDownRight, mouthUpperUpLeft,
  // mouthUpperUpRight, tongueOut
  std::array<float, kSpeechControls> controls = {};
  float activity = 0.0f;  // 0..1: how probable it is that somebody speaks
};

class AudioNet {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const engine::Model& model, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // A new stream begins.
  void reset();

  [[nodiscard]] Speech process(std::span<const float, FrontEnd::kFeatures> features);

 private:
  engine::Network encoder_;
  engine::Network controls_;
  engine::Network activity_;
};

}  // namespace mien::audio
