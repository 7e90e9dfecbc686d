#include "tracker/hifinet.h"

#include <algorithm>
#include <cmath>

namespace mien::tracker {
namespace {

constexpr Raster kClose = {129, 109, 0.87f};

}  // namespace

mien_status HiFiNet::load(const Models& models, std::uint32_t cpu_mask, Arena& arena) {
  if (!sampler_.init(cpu_mask)) {
    return MIEN_ERROR_UNSUPPORTED_CPU;
  }
  const NetworkForm encoder = {"encoder", {kClose.rows, kClose.columns, 3}, {kFeatures}};
  const mien_status status = encoder_.load(models.hifinet, encoder, cpu_mask, arena);
  return status == MIEN_OK
             ? landmarks_.load(models.hifinet, {"landmarks", kFeatureVector, {2 * kLandmarks}},
                               cpu_mask, arena)
             : status;
}

bool HiFiNet::look(const ImageView& view, const Crop& crop, StageTimer& timer, CloseSight& sight) {
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_WARP);
    sampler_.cut(view, crop, kClose, encoder_.input());
  }
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_ENCODER);
    encoder_.run();
  }
  const StageTimer::Scope timed(timer, MIEN_STAGE_HEADS);
  const std::span<const float> features = encoder_.output(0).first(kFeatures);
  const std::span<const float> xy = landmarks_.run(features);
  if (!all_finite(features) || !all_finite(xy)) {
    return false;
  }
  std::copy(features.begin(), features.end(), sight.features.begin());
  sight.landmarks = landmarks_in(crop, xy);
  return true;
}

}  // namespace mien::tracker
