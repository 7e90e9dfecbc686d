// Smoothing that follows fast motion at once: the 1-euro filter (Casiez, Roussel and Vogel 2012),
// its cutoff driven by the unfiltered step, so that a blink opens it on its first frame.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tracker/geometry/geometry.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

// Share of the way from the last output to the input that one step goes.
struct OneEuro {
  float still_hz;  // cutoff for what does not move
  float per_unit;  // added to it per unit of distance in a second

  [[nodiscard]] float share(float distance, float seconds) const {
    constexpr float kTwoPi = 6.2831853f;
    const float cutoff = still_hz + per_unit * distance / seconds;
    const float turns = kTwoPi * cutoff * seconds;
    return turns / (1.0f + turns);
  }
};

// For controls: 0.01 of trembling is halved; a step of 0.3 passes to 97 %.
inline constexpr OneEuro kControlSmoothing = {1.5f, 12.0f};
// For landmarks, in sides of the crop.
inline constexpr OneEuro kLandmarkSmoothing = {1.5f, 60.0f};
// For the head: radians, and metres.
inline constexpr OneEuro kRotationSmoothing = {1.5f, 15.0f};
inline constexpr OneEuro kTranslationSmoothing = {1.5f, 15.0f};

// Each moves `shown` towards `seen`; `seconds` > 0 have passed since the last step.
void smooth_controls(std::span<const float> seen, float seconds, std::span<float> shown);
void smooth_points(std::span<const Point> seen, float side, float seconds, std::span<Point> shown);
void smooth_pose(const HeadPose& seen, float seconds, HeadPose& shown);

}  // namespace mien::tracker
