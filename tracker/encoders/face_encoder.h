// The common part of BaseNet and HiFiNet: warps a crop, runs an encoder and its landmark head.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "engine/arena.h"
#include "engine/model.h"
#include "engine/network.h"
#include "tracker/decoders/controls_decoder.h"
#include "tracker/encoders/landmarks.h"
#include "tracker/geometry/crop.h"
#include "tracker/image/image_view.h"
#include "tracker/image/sampler.h"
#include "tracker/stage_timer.h"

namespace mien::tracker {

// The output of the networks for one crop.
struct Encoding {
  Crop crop;
  float face_probability = 0.0f;  // 0..1; only BaseNet sets it
  Landmarks landmarks = {};
  Features features = {};
};

class FaceEncoder {
 public:
  // Takes the networks' memory from `arena`, or only measures it if the arena does.
  [[nodiscard]] mien_status load(const engine::Model& model, const Raster& raster,
                                 std::uint32_t cpu_mask, engine::Arena& arena);

  // False if an output of the networks is not finite.
  [[nodiscard]] bool encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                            Encoding& encoding);

 private:
  Sampler sampler_;
  Raster raster_ = {};
  engine::Network encoder_;
  engine::Network landmarks_;
};

}  // namespace mien::tracker
