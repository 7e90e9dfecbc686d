// A controls decoder: an encoder's features, over time, to the 52 controls.
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
  // Takes from `arena` what the network needs; only measures when the arena does.
  [[nodiscard]] mien_status load(const engine::Model& model, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // Bit i: control i is driven.
  [[nodiscard]] std::uint64_t supported() const { return supported_; }

  // One step, for one frame of output: 0..1, and 0 where not supported.
  void decode(std::span<const float, kFeatures> features, std::span<float, kControls> controls);

  // A new stream begins.
  void reset() { decoder_.reset(); }

 private:
  engine::Network decoder_;
  std::uint64_t supported_ = 0;
};

}  // namespace mien::tracker
