// Runs AudioNet.
#include "audio/audio_net.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace mien::audio {
namespace {

constexpr engine::Shape kInput = {1, 1, FrontEnd::kFeatures};
constexpr std::int32_t kEmbedding = 80;
constexpr engine::Shape kEmbedded = {1, 1, kEmbedding};
constexpr std::string_view kJawDecoder = "jaw_decoder";
constexpr engine::Shape kJawInput = {1, 1, kEmbedding + static_cast<std::int32_t>(kBands)};
constexpr std::size_t kJawOpen = 0;   // index in Speech::controls
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
  if (status == MIEN_OK) {
    status = activity_.load(model, {"activity_decoder", kEmbedded, {kClasses}}, cpu_mask, arena);
  }
  return status == MIEN_OK ? load_jaw(model, cpu_mask, arena) : status;
}

mien_status AudioNet::load_jaw(const engine::Model& model, std::uint32_t cpu_mask,
                               engine::Arena& arena) {
  has_jaw_ = model.network(kJawDecoder) != nullptr;
  return has_jaw_ ? jaw_.load(model, {kJawDecoder, kJawInput, {1}}, cpu_mask, arena) : MIEN_OK;
}

void AudioNet::reset() {
  encoder_.reset();
  controls_.reset();
  activity_.reset();
  if (has_jaw_) {
    jaw_.reset();
    loudness_.reset();
  }
}

Speech AudioNet::process(std::span<const float, FrontEnd::kFeatures> features,
                         std::span<const float, kBands> log_mel) {
  const std::span<const float> embedding = encoder_.run(features).first(kEmbedding);
  Speech speech;
  const std::span<const float> controls = controls_.run(embedding);
  std::transform(controls.begin(), controls.begin() + kSpeechControls, speech.controls.begin(),
                 clamped);
  speech.activity = clamped(activity_.run(embedding)[1]);
  if (has_jaw_) {
    speech.controls[kJawOpen] = jaw_open(embedding, log_mel);
  }
  return speech;
}

float AudioNet::jaw_open(std::span<const float> embedding, std::span<const float, kBands> log_mel) {
  std::array<float, kEmbedding + kBands> input;
  std::copy(embedding.begin(), embedding.end(), input.begin());
  loudness_.subtract(log_mel, std::span(input).last<kBands>());
  return clamped(jaw_.run(input)[0]);
}

}  // namespace mien::audio
