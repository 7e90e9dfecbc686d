// Runs AudioNet.
#include "audio/audio_net.h"

#include <algorithm>
#include <cmath>

namespace mien::audio {
namespace {

constexpr engine::Shape kInput = {1, 1, FrontEnd::kFeatures};
constexpr std::int32_t kEmbedding = 80;
constexpr engine::Shape kEmbedded = {1, 1, kEmbedding};
constexpr std::int32_t kClasses = 2;  // no speech, speech

float clamped(float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f; }

}  // namespace

mien_status AudioNet::load(const engine::Model& model, std::uint32_t cpu_mask,
                           engine::Arena& arena) {
  mien_status status = encoder_.load(model, {"encoder", kInput, {kEmbedding}}, cpu_mask, arena);
  if (status == MIEN_OK) {
    status =
        controls_.load(model, {"controls_decoder", kEmbedded, {kSpeechControls}}, cpu_mask, arena);
  }
  return status == MIEN_OK
             ? activity_.load(model, {"activity_decoder", kEmbedded, {kClasses}}, cpu_mask, arena)
             : status;
}

void AudioNet::reset() {
  encoder_.reset();
  controls_.reset();
  activity_.reset();
}

Speech AudioNet::process(std::span<const float, FrontEnd::kFeatures> features) {
  const std::span<const float> embedding = encoder_.run(features).first(kEmbedding);
  Speech speech;
  const std::span<const float> controls = controls_.run(embedding);
  std::transform(controls.begin(), controls.begin() + kSpeechControls, speech.controls.begin(),
                 clamped);
  speech.activity = clamped(activity_.run(embedding)[1]);
  return speech;
}

}  // namespace mien::audio
