// Runs the decoders of a face and crossfades between them.
#include "tracker/decoders/decoders.h"

#include <cstddef>

namespace mien::tracker {
namespace {

void decode(ControlsDecoder& decoder, Neutral& neutral, const Features& features,
            std::span<float, kControls> controls) {
  decoder.decode(features, controls);
  neutral.observe(controls);
  neutral.remove(controls);
}

}  // namespace

mien_status Decoders::load(const Models& models, std::uint32_t cpu_mask, engine::Arena& arena) {
  mien_status status = basenet_controls_.load(models.basenet, cpu_mask, arena);
  if (status == MIEN_OK && models.has_hifinet) {
    status = hifinet_controls_.load(models.hifinet, cpu_mask, arena);
  }
  return status == MIEN_OK
             ? pose_.load(models.basenet, {"pose_decoder", kFeatureVector, {kPoseOutputs}},
                          cpu_mask, arena)
             : status;
}

void Decoders::reset(std::int32_t level) {
  basenet_controls_.reset();
  if (level > kMinLevel) {
    hifinet_controls_.reset();
  }
  basenet_neutral_.restart();
  hifinet_neutral_.restart();
  pose_.reset();
  fade_.jump(level > kMinLevel);
}

void Decoders::decode_controls(const Features& basenet, const Features& hifinet, std::int32_t level,
                               float seconds, std::span<float, kControls> controls) {
  const bool to_hifinet = level > kMinLevel;
  if (to_hifinet && !fade_.second_is_active()) {
    hifinet_controls_.reset();
  }
  if (!to_hifinet && !fade_.first_is_active()) {
    basenet_controls_.reset();
  }
  transfer_capture(level);
  fade_.advance(to_hifinet, seconds);
  if (!fade_.second_is_active()) {
    decode(basenet_controls_, basenet_neutral_, basenet, controls);
    return;
  }
  if (!fade_.first_is_active()) {
    decode(hifinet_controls_, hifinet_neutral_, hifinet, controls);
    return;
  }
  std::array<float, kControls> basenet_values;
  decode(basenet_controls_, basenet_neutral_, basenet, basenet_values);
  decode(hifinet_controls_, hifinet_neutral_, hifinet, controls);
  const float weight = fade_.weight();
  for (std::size_t i = 0; i < basenet_values.size(); ++i) {
    controls[i] = basenet_values[i] + weight * (controls[i] - basenet_values[i]);
  }
}

// Captures at most one decoder, and never the one that fades out.
void Decoders::transfer_capture(std::int32_t level) {
  Neutral& other = neutral(level > kMinLevel ? kMinLevel : kMaxLevel);
  if (other.is_being_captured()) {
    other.cancel();
    neutral(level).capture();
  }
}

float Decoders::supported_weight(std::size_t control) const {
  const auto supports = [control](const ControlsDecoder& decoder) {
    return static_cast<float>(decoder.supported() >> control & 1u);
  };
  const float weight = fade_.weight();
  return (1.0f - weight) * supports(basenet_controls_) + weight * supports(hifinet_controls_);
}

void Decoders::decode_pose(const Features& basenet, const Crop& crop, const Camera& camera,
                           HeadPose& pose) {
  const std::span<const float> prediction = pose_.run(basenet);
  (void)decode_head_pose(prediction.first<kPoseOutputs>(), crop, camera, pose);
}

}  // namespace mien::tracker
