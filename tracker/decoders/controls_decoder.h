// A controls decoder: converts an encoder's features over time to the 52 controls.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>
#include <span>

#include "engine/arena.h"
#include "engine/model.h"
#include "engine/network.h"
#include "tracker/decoders/controls.h"

namespace mien::tracker {

inline constexpr std::int32_t kFeatures = 256;
inline constexpr engine::Shape kFeatureVector = {1, 1, kFeatures};
using Features = std::array<float, kFeatures>;

class ControlsDecoder {
 public:
  // Takes the network's memory from `arena`, or only measures it if the arena does.
  [[nodiscard]] mien_status load(const engine::Model& model, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // Bit i: the network predicts control i.
  [[nodiscard]] std::uint64_t supported() const { return supported_; }

  // Computes the controls of one frame, 0..1; those not supported are 0.
  void decode(std::span<const float, kFeatures> features, std::span<float, kControls> controls);

  // Resets the state to the start of a stream.
  void reset() { decoder_.reset(); }

 private:
  engine::Network decoder_;
  std::uint64_t supported_ = 0;
};

}  // namespace mien::tracker
