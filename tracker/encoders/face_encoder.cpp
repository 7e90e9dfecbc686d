// Runs an encoder and its landmark head on a crop.
#include "tracker/encoders/face_encoder.h"

#include <algorithm>

namespace mien::tracker {

mien_status FaceEncoder::load(const engine::Model& model, const Raster& raster,
                              std::uint32_t cpu_mask, engine::Arena& arena) {
  if (!sampler_.init(cpu_mask, arena)) {
    return MIEN_ERROR_UNSUPPORTED_CPU;
  }
  raster_ = raster;
  const engine::NetworkForm encoder = {"encoder", {raster.rows, raster.columns, 3}, {kFeatures}};
  const engine::NetworkForm landmarks = {"landmarks", kFeatureVector, {2 * kLandmarks}};
  const mien_status status = encoder_.load(model, encoder, cpu_mask, arena);
  return status == MIEN_OK ? landmarks_.load(model, landmarks, cpu_mask, arena) : status;
}

bool FaceEncoder::encode(const ImageView& view, const Crop& crop, StageTimer& timer,
                         Encoding& encoding) {
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_WARP);
    sampler_.warp(view, crop, raster_, encoder_.input());
  }
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_ENCODER);
    encoder_.run();
  }
  const StageTimer::Scope timed(timer, MIEN_STAGE_HEADS);
  encoding.crop = crop;
  std::copy_n(encoder_.output(0).begin(), kFeatures, encoding.features.begin());
  const std::span<const float> xy = landmarks_.run(encoding.features);
  encoding.landmarks = landmarks_in(crop, xy);
  return all_finite(encoding.features) && all_finite(xy);
}

}  // namespace mien::tracker
