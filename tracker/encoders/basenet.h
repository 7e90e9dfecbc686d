// BaseNet: one 65x65 crop to landmarks, face probability, and the features that decoders read.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "engine/arena.h"
#include "engine/network.h"
#include "tracker/encoders/face_encoder.h"
#include "tracker/encoders/models.h"
#include "tracker/geometry/crop.h"
#include "tracker/geometry/pose_refinement.h"

namespace mien::tracker {

class BaseNet {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // Encoder and plain heads. False when the networks' answer is not finite.
  [[nodiscard]] bool encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                            Encoding& encoding);

  // The crop that the landmarks of `sight` ask for.
  [[nodiscard]] bool align(const Encoding& encoding, Crop& crop) const {
    return fit_crop(template_, encoding.landmarks, crop);
  }

  // Unknown if the weights are from before they were told.
  [[nodiscard]] HeadPoints head_points() const { return head_points_; }

 private:
  [[nodiscard]] mien_status load_template(const engine::Model& model);
  [[nodiscard]] mien_status load_head_points(const engine::Model& model);

  FaceEncoder encoder_;
  engine::Network face_probability_;
  Landmarks template_ = {};  // in crop coordinates
  HeadPoints head_points_;   // in the weights
};

}  // namespace mien::tracker
