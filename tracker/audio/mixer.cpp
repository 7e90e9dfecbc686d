// Mixes controls predicted from audio and video.
#include "tracker/audio/mixer.h"

#include <algorithm>

namespace mien::tracker {
namespace {

// False for NaN.
bool is_weight(float value) { return value >= 0.0f && value <= 1.0f; }

[[nodiscard]] mien_status read(const engine::Model& model, const char* name, Controls& weights) {
  std::span<const float> values;
  const mien_status status = model.constant(name, kControls, values);
  if (status != MIEN_OK) {
    return status;
  }
  const auto* bad = std::find_if_not(values.data(), values.data() + values.size(), is_weight);
  if (bad != values.data() + values.size()) {
    return model.bad_constant(MIEN_ERROR_WEIGHTS_VALUE, name, static_cast<double>(*bad), 0.0, 1.0);
  }
  std::copy(values.begin(), values.end(), weights.begin());
  return MIEN_OK;
}

}  // namespace

mien_status Mixer::load(const engine::Model& model) {
  mien_status status = read(model, "mix_audio", loaded_.audio);
  if (status == MIEN_OK) {
    status = read(model, "mix_video", loaded_.video);
  }
  restore();
  return status;
}

bool Mixer::set_weights(std::size_t control, float audio, float video) {
  if (!is_weight(audio) || !is_weight(video)) {
    return false;
  }
  weights_.audio[control] = audio;
  weights_.video[control] = video;
  return true;
}

std::uint64_t Mixer::driven() const {
  std::uint64_t driven = 0;
  for (std::size_t i = 0; i < kControls; ++i) {
    driven |= static_cast<std::uint64_t>(weights_.audio[i] > 0.0f) << i;
  }
  return driven;
}

void Mixer::mix(const AudioOutput& output, std::span<const float, kControls> video_weights,
                std::span<float, kControls> controls) const {
  for (std::size_t i = 0; i < kControls; ++i) {
    if (weights_.audio[i] <= 0.0f) {
      continue;
    }
    const float audio = 1.0f + video_weights[i] * (weights_.audio[i] - 1.0f);
    const float video = video_weights[i] * weights_.video[i];
    const float mixed = audio * output.controls[i] + video * controls[i];
    controls[i] = std::clamp(controls[i] + output.alpha * (mixed - controls[i]), 0.0f, 1.0f);
  }
}

}  // namespace mien::tracker
