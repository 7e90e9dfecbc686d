#include "tracker/basenet.h"

#include <algorithm>
#include <cmath>

namespace mien::tracker {
namespace {

constexpr std::int32_t kCropSamples = 65;

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

constexpr engine::Shape kFeatureVector = {1, 1, kFeatures};

}  // namespace

mien_status BaseNet::load(const mien_tracker_config& config, Arena& arena) {
  if (!sampler_.init(config.cpu_mask)) {
    return MIEN_ERROR_UNSUPPORTED_CPU;
  }
  engine::Model model;
  mien_status status = open_model(config.basenet, config.basenet_bytes, model);
  if (status == MIEN_OK) {
    status = load_networks(model, config.cpu_mask, arena);
  }
  return status == MIEN_OK ? load_constants(model) : status;
}

mien_status BaseNet::load_networks(const engine::Model& model, std::uint32_t cpu_mask,
                                   Arena& arena) {
  const struct {
    Network& network;
    NetworkForm form;
  } parts[] = {
      {encoder_, {"encoder", {kCropSamples, kCropSamples, 3}, {kFeatures}}},
      {landmarks_, {"landmarks", kFeatureVector, {2 * kLandmarks}}},
      {face_probability_, {"face_probability", kFeatureVector, {1}}},
      {controls_decoder_, {"controls_decoder", kFeatureVector, {kControls}}},
      {pose_decoder_, {"pose_decoder", kFeatureVector, {kPoseOutputs}}},
  };
  for (const auto& part : parts) {
    const mien_status status = part.network.load(model, part.form, cpu_mask, arena);
    if (status != MIEN_OK) {
      return status;
    }
  }
  return MIEN_OK;
}

mien_status BaseNet::load_constants(const engine::Model& model) {
  std::span<const float> shape;
  std::span<const float> supported;
  if (model.constant("landmark_template", 2 * kLandmarks, shape) != engine::Status::kOk ||
      model.constant("control_supported", kControls, supported) != engine::Status::kOk) {
    return MIEN_ERROR_WEIGHTS_INCOMPLETE;
  }
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    template_[i] = {shape[2 * i], shape[2 * i + 1]};
  }
  supported_ = 0;
  for (std::size_t i = 0; i < kControls; ++i) {
    supported_ |= static_cast<std::uint64_t>(supported[i] > 0.5f) << i;
  }
  return MIEN_OK;
}

bool BaseNet::look(const ImageView& view, const Crop& crop, StageTimer& timer, Sight& sight) {
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_WARP);
    sampler_.cut(view, crop, kCropSamples, encoder_.input());
  }
  {
    const StageTimer::Scope timed(timer, MIEN_STAGE_ENCODER);
    encoder_.run();
  }
  const StageTimer::Scope timed(timer, MIEN_STAGE_HEADS);
  sight.crop = crop;
  std::copy_n(encoder_.output(0).begin(), kFeatures, sight.features.begin());
  const std::span<const float> xy = landmarks_.run(sight.features);
  const Affine to_scene = crop_to_image(crop);
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    sight.landmarks[i] = to_scene({xy[2 * i], xy[2 * i + 1]});
  }
  sight.face_probability = face_probability_.run(sight.features)[0];
  return all_finite(sight.features) && all_finite(xy) && std::isfinite(sight.face_probability);
}

void BaseNet::decode_controls(const Sight& sight, std::span<float, kControls> controls) {
  const std::span<const float> decoded = controls_decoder_.run(sight.features);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const bool driven = (supported_ >> i & 1u) != 0 && std::isfinite(decoded[i]);
    controls[i] = driven ? std::clamp(decoded[i], 0.0f, 1.0f) : 0.0f;
  }
}

void BaseNet::decode_pose(const Sight& sight, const Camera& camera, HeadPose& pose) {
  const std::span<const float> prediction = pose_decoder_.run(sight.features);
  (void)decode_head_pose(prediction.first<kPoseOutputs>(), sight.crop, camera, pose);
}

void BaseNet::reset() {
  controls_decoder_.reset();
  pose_decoder_.reset();
}

}  // namespace mien::tracker
