// HiFiNet: the face alone, 129 x 109, to features that tell all controls, and finer landmarks.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "tracker/arena.h"
#include "tracker/controls_decoder.h"
#include "tracker/crop.h"
#include "tracker/image_view.h"
#include "tracker/landmarks.h"
#include "tracker/models.h"
#include "tracker/network.h"
#include "tracker/sampler.h"
#include "tracker/stage_timer.h"

namespace mien::tracker {

// What HiFiNet sees in one crop.
struct CloseSight {
  Features features = {};
  Landmarks landmarks = {};
};

class HiFiNet {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask, Arena& arena);

  // Looks at the middle of the crop that the landmarks of this very frame ask for. False, and
  // `sight` untouched, when the networks' answer is not finite.
  [[nodiscard]] bool look(const ImageView& view, const Crop& crop, StageTimer& timer,
                          CloseSight& sight);

 private:
  Sampler sampler_;
  Network encoder_;
  Network landmarks_;
};

}  // namespace mien::tracker
