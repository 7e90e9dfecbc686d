// BaseNet: one 65x65 crop to landmarks and face probability; its features, over time, to controls
// and head pose.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>
#include <span>

#include "tracker/arena.h"
#include "tracker/controls.h"
#include "tracker/crop.h"
#include "tracker/head_pose.h"
#include "tracker/image_view.h"
#include "tracker/network.h"
#include "tracker/sampler.h"
#include "tracker/stage_timer.h"

namespace mien::tracker {

inline constexpr std::int32_t kFeatures = 256;
inline constexpr std::size_t kLandmarks = 175;

// What BaseNet sees in one crop.
struct Sight {
  Crop crop;
  float face_probability = 0.0f;                 // 0..1
  std::array<Point, kLandmarks> landmarks = {};  // pixels of the scene
  std::array<float, kFeatures> features = {};
};

class BaseNet {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const mien_tracker_config& config, Arena& arena);

  [[nodiscard]] std::uint64_t supported_controls() const { return supported_; }

  // Encoder and plain heads. False when the networks' answer is not finite.
  [[nodiscard]] bool look(const ImageView& view, const Crop& crop, StageTimer& timer, Sight& sight);

  // The crop that the landmarks of `sight` ask for.
  [[nodiscard]] bool align(const Sight& sight, Crop& crop) const {
    return fit_crop(template_, sight.landmarks, crop);
  }

  // One step of the temporal decoders, for one frame of output. A pose that is none leaves the
  // last.
  void decode_controls(const Sight& sight, std::span<float, kControls> controls);
  void decode_pose(const Sight& sight, const Camera& camera, HeadPose& pose);

  // The decoders begin a new stream.
  void reset();

 private:
  [[nodiscard]] mien_status load_networks(const engine::Model& model, std::uint32_t cpu_mask,
                                          Arena& arena);
  [[nodiscard]] mien_status load_constants(const engine::Model& model);

  Sampler sampler_;
  Network encoder_;
  Network landmarks_;
  Network face_probability_;
  Network controls_decoder_;
  Network pose_decoder_;
  std::array<Point, kLandmarks> template_ = {};  // crop coordinates
  std::uint64_t supported_ = 0;
};

}  // namespace mien::tracker
