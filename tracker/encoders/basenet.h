// BaseNet: converts a crop of 65 x 65 samples to landmarks, face probability and features.
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
  // Takes the networks' memory from `arena`, or only measures it if the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // Runs the encoder and the heads. False if an output of the networks is not finite.
  [[nodiscard]] bool encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                            Encoding& encoding);

  // Fits a crop to the landmarks. False, and `crop` unchanged, if none fits.
  [[nodiscard]] bool align(const Encoding& encoding, Crop& crop) const {
    return fit_crop(template_, encoding.landmarks, crop);
  }

  // Empty if the weight file predates this constant.
  [[nodiscard]] HeadPoints head_points() const { return head_points_; }

 private:
  [[nodiscard]] mien_status load_template(const engine::Model& model);
  [[nodiscard]] mien_status load_head_points(const engine::Model& model);

  FaceEncoder encoder_;
  engine::Network face_probability_;
  Landmarks template_ = {};  // mean shape, in crop coordinates
  HeadPoints head_points_;   // refers to the weight file
};

}  // namespace mien::tracker
