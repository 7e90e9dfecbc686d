// HiFiNet: the face alone, 129 x 109, to features that tell all controls, and finer landmarks.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "engine/arena.h"
#include "tracker/encoders/face_encoder.h"
#include "tracker/encoders/models.h"

namespace mien::tracker {

class HiFiNet {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask,
                                 engine::Arena& arena) {
    return encoder_.load(models.hifinet, {129, 109, 0.87f}, cpu_mask, arena);
  }

  // Looks at the middle of the crop that the landmarks of this very frame ask for. False when the
  // networks' answer is not finite.
  [[nodiscard]] bool encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                            Encoding& encoding) {
    return encoder_.encode(view, crop, timer, encoding);
  }

 private:
  FaceEncoder encoder_;
};

}  // namespace mien::tracker
