// HiFiNet: the face alone, 129 x 109, to features that tell all controls.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "tracker/arena.h"
#include "tracker/controls_decoder.h"
#include "tracker/crop.h"
#include "tracker/image_view.h"
#include "tracker/models.h"
#include "tracker/network.h"
#include "tracker/sampler.h"
#include "tracker/stage_timer.h"

namespace mien::tracker {

class HiFiNet {
 public:
  // Takes from `arena` what the encoder needs; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask, Arena& arena);

  // Looks at the middle of the crop that the landmarks of this very frame ask for. False, and
  // `features` untouched, when the network's answer is not finite.
  [[nodiscard]] bool look(const ImageView& view, const Crop& crop, StageTimer& timer,
                          Features& features);

 private:
  Sampler sampler_;
  Network encoder_;
};

}  // namespace mien::tracker
