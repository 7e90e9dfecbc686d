// Smoothing that follows fast motion without delay: the 1-euro filter (Casiez, Roussel and Vogel
// 2012). Its cutoff depends on the unfiltered step, so that it rises on the first frame of a blink.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tracker/geometry/geometry.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

// The coefficients of a filter.
struct OneEuro {
  float still_hz;  // cutoff at rest
  float per_unit;  // increase of the cutoff per unit of speed

  // The step from the last output towards the input, as a fraction of their distance.
  [[nodiscard]] float alpha(float distance, float seconds) const {
    constexpr float kTwoPi = 6.2831853f;
    const float cutoff = still_hz + per_unit * distance / seconds;
    const float angle = kTwoPi * cutoff * seconds;
    return angle / (1.0f + angle);
  }
};

// Controls: halves jitter of 0.01; a step of 0.3 passes to 97 %.
inline constexpr OneEuro kControlSmoothing = {1.5f, 12.0f};
// Landmarks, in units of the crop's side.
inline constexpr OneEuro kLandmarkSmoothing = {1.5f, 60.0f};
// Head pose: radians and metres.
inline constexpr OneEuro kRotationSmoothing = {1.5f, 15.0f};
inline constexpr OneEuro kTranslationSmoothing = {1.5f, 15.0f};

// Each moves `smoothed` towards `raw`; `seconds` > 0 since the last step. `side`: of the crop,
// pixels.
void smooth_controls(std::span<const float> raw, float seconds, std::span<float> smoothed);
void smooth_points(std::span<const Point> raw, float side, float seconds,
                   std::span<Point> smoothed);
void smooth_pose(const HeadPose& raw, float seconds, HeadPose& smoothed);

}  // namespace mien::tracker
