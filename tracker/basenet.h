// BaseNet: one 65x65 crop to landmarks, face probability, and the features that decoders read.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>
#include <span>

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

// What BaseNet sees in one crop.
struct Sight {
  Crop crop;
  float face_probability = 0.0f;  // 0..1
  Landmarks landmarks = {};
  Features features = {};
};

class BaseNet {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask, Arena& arena);

  // Encoder and plain heads. False when the networks' answer is not finite.
  [[nodiscard]] bool look(const ImageView& view, const Crop& crop, StageTimer& timer, Sight& sight);

  // The crop that the landmarks of `sight` ask for.
  [[nodiscard]] bool align(const Sight& sight, Crop& crop) const {
    return fit_crop(template_, sight.landmarks, crop);
  }

 private:
  [[nodiscard]] mien_status load_networks(const engine::Model& model, std::uint32_t cpu_mask,
                                          Arena& arena);
  [[nodiscard]] mien_status load_template(const engine::Model& model);

  Sampler sampler_;
  Network encoder_;
  Network landmarks_;
  Network face_probability_;
  Landmarks template_ = {};  // in crop coordinates
};

}  // namespace mien::tracker
