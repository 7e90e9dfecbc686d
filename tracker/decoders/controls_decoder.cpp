// Runs a controls decoder and limits its output.
#include "tracker/decoders/controls_decoder.h"

#include <algorithm>
#include <cmath>

#include "tracker/decoders/symmetry.h"

namespace mien::tracker {

mien_status ControlsDecoder::load(const engine::Model& model, std::uint32_t cpu_mask,
                                  engine::Arena& arena) {
  std::span<const float> supported;
  const mien_status status = model.constant("control_supported", kControls, supported);
  if (status != MIEN_OK) {
    return status;
  }
  supported_ = 0;
  for (std::size_t i = 0; i < kControls; ++i) {
    supported_ |= static_cast<std::uint64_t>(supported[i] > 0.5f) << i;
  }
  return decoder_.load(model, {"controls_decoder", kFeatureVector, {kControls}}, cpu_mask, arena);
}

void ControlsDecoder::decode(std::span<const float, kFeatures> features,
                             std::span<float, kControls> controls) {
  const std::span<const float> decoded = decoder_.run(features);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const bool valid = (supported_ >> i & 1u) != 0 && std::isfinite(decoded[i]);
    controls[i] = valid ? std::clamp(decoded[i], 0.0f, 1.0f) : 0.0f;
  }
  symmetrize(supported_, controls);
}

}  // namespace mien::tracker
