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
  return encoder_.load(models.hifinet, {"encoder", {kClose.rows, kClose.columns, 3}, {kFeatures}},
                       cpu_mask, arena);
}

bool HiFiNet::look(const ImageView& view, const Crop& crop, StageTimer& timer, Features& features) {
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_WARP);
    sampler_.cut(view, crop, kClose, encoder_.input());
  }
  const StageTimer::Scope timed(timer, MIEN_STAGE_ENCODER);
  encoder_.run();
  const std::span<const float> found = encoder_.output(0).first(kFeatures);
  if (!all_finite(found)) {
    return false;
  }
  std::ranges::copy(found, features.begin());
  return true;
}

}  // namespace mien::tracker
