// AudioNet: converts audio features, in steps of 16 ms, to the controls of speech and to voice
// activity (Navarro et al. 2023, section 4).
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "audio/front_end.h"
#include "audio/loudness.h"
#include "engine/arena.h"
#include "engine/model.h"
#include "engine/network.h"

namespace mien::audio {

inline constexpr std::size_t kSpeechControls = 18;

// The prediction for one time.
struct Speech {
  // 0..1: jawOpen, jawForward, mouthClose, mouthFunnel, mouthPucker, mouthRollLower,
  // mouthRollUpper, mouthShrugLower, mouthShrugUpper, mouthPressLeft, mouthPressRight,
  // mouthStretchLeft, mouthStretchRight, mouthLowerDownLeft, mouthLowerDownRight, mouthUpperUpLeft,
  // mouthUpperUpRight, tongueOut
  std::array<float, kSpeechControls> controls = {};
  float activity = 0.0f;  // 0..1: probability of speech
};

class AudioNet {
 public:
  // Takes the networks' memory from `arena`, or only measures it if the arena does.
  [[nodiscard]] mien_status load(const engine::Model& model, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // Resets the state to the start of a stream.
  void reset();

  // One step: the features of the front end, and the log-mel energies of their newest window.
  [[nodiscard]] Speech process(std::span<const float, FrontEnd::kFeatures> features,
                               std::span<const float, kBands> log_mel);

 private:
  [[nodiscard]] mien_status load_jaw(const engine::Model& model, std::uint32_t cpu_mask,
                                     engine::Arena& arena);
  [[nodiscard]] float jaw_open(std::span<const float> embedding,
                               std::span<const float, kBands> log_mel);

  engine::Network encoder_;
  engine::Network controls_;
  engine::Network activity_;
  engine::Network jaw_;  // only if has_jaw_
  bool has_jaw_ = false;
  Loudness loudness_;
};

}  // namespace mien::audio
