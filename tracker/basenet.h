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

}  // namespace mien::tracker
