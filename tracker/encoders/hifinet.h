// HiFiNet: converts a narrow crop of 129 x 109 samples to features for all controls, and to finer
// landmarks.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "engine/arena.h"
#include "tracker/encoders/face_encoder.h"
#include "tracker/encoders/models.h"

namespace mien::tracker {

class HiFiNet {
 public:
  // Takes the networks' memory from `arena`, or only measures it if the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask,
                                 engine::Arena& arena) {
    return encoder_.load(models.hifinet, {129, 109, 0.87f}, cpu_mask, arena);
  }

  // Reads the middle of `crop`, which BaseNet's landmarks of the same frame place. False if an
  // output of the networks is not finite.
  [[nodiscard]] bool encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                            Encoding& encoding) {
    return encoder_.encode(view, crop, timer, encoding);
  }

 private:
  FaceEncoder encoder_;
};

}  // namespace mien::tracker
