#include "tracker/basenet.h"

#include <algorithm>
#include <cmath>

namespace mien::tracker {
namespace {

constexpr Raster kWhole = {65, 65, 1.0f};

}  // namespace

mien_status BaseNet::load(const Models& models, std::uint32_t cpu_mask, Arena& arena) {
  if (!sampler_.init(cpu_mask)) {
    return MIEN_ERROR_UNSUPPORTED_CPU;
  }
  const mien_status status = load_networks(models.basenet, cpu_mask, arena);
  return status == MIEN_OK ? load_template(models.basenet) : status;
}

mien_status BaseNet::load_networks(const engine::Model& model, std::uint32_t cpu_mask,
                                   Arena& arena) {
  const struct {
    Network& network;
    NetworkForm form;
  } parts[] = {
      {encoder_, {"encoder", {kWhole.rows, kWhole.columns, 3}, {kFeatures}}},
      {landmarks_, {"landmarks", kFeatureVector, {2 * kLandmarks}}},
      {face_probability_, {"face_probability", kFeatureVector, {1}}},
  };
  for (const auto& part : parts) {
    const mien_status status = part.network.load(model, part.form, cpu_mask, arena);
    if (status != MIEN_OK) {
      return status;
    }
  }
  return MIEN_OK;
}

mien_status BaseNet::load_template(const engine::Model& model) {
  std::span<const float> shape;
  if (model.constant("landmark_template", 2 * kLandmarks, shape) != engine::Status::kOk) {
    return MIEN_ERROR_WEIGHTS_INCOMPLETE;
  }
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    template_[i] = {shape[2 * i], shape[2 * i + 1]};
  }
  return MIEN_OK;
}

bool BaseNet::look(const ImageView& view, const Crop& crop, StageTimer& timer, Sight& sight) {
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_WARP);
    sampler_.cut(view, crop, kWhole, encoder_.input());
  }
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_ENCODER);
    encoder_.run();
  }
  const StageTimer::Scope timed(timer, MIEN_STAGE_HEADS);
  sight.crop = crop;
  std::copy_n(encoder_.output(0).begin(), kFeatures, sight.features.begin());
  const std::span<const float> xy = landmarks_.run(sight.features);
  sight.landmarks = landmarks_in(crop, xy);
  sight.face_probability = face_probability_.run(sight.features)[0];
  return all_finite(sight.features) && all_finite(xy) && std::isfinite(sight.face_probability);
}

}  // namespace mien::tracker
