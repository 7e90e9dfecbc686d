// Loads and runs BaseNet.
#include "tracker/encoders/basenet.h"

#include <cmath>
#include <string_view>

namespace mien::tracker {

mien_status BaseNet::load(const Models& models, std::uint32_t cpu_mask, engine::Arena& arena) {
  const engine::Model& model = models.basenet;
  mien_status status = encoder_.load(model, {65, 65, 1.0f}, cpu_mask, arena);
  if (status == MIEN_OK) {
    status =
        face_probability_.load(model, {"face_probability", kFeatureVector, {1}}, cpu_mask, arena);
  }
  if (status == MIEN_OK) {
    status = load_template(model);
  }
  return status == MIEN_OK ? load_head_points(model) : status;
}

mien_status BaseNet::load_template(const engine::Model& model) {
  std::span<const float> shape;
  const mien_status status = model.constant("landmark_template", 2 * kLandmarks, shape);
  if (status != MIEN_OK) {
    return status;
  }
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    template_[i] = {shape[2 * i], shape[2 * i + 1]};
  }
  return MIEN_OK;
}

mien_status BaseNet::load_head_points(const engine::Model& model) {
  constexpr std::string_view kName = "head_points";
  const bool present = model.file().find_constant(kName) != nullptr;
  return present ? model.constant(kName, kHeadPoints, head_points_) : MIEN_OK;
}

bool BaseNet::encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                     Encoding& encoding) {
  const bool finite = encoder_.encode(view, crop, timer, encoding);
  const StageTimer::Scope timed(timer, MIEN_STAGE_HEADS);
  encoding.face_probability = face_probability_.run(encoding.features)[0];
  return finite && std::isfinite(encoding.face_probability);
}

}  // namespace mien::tracker
