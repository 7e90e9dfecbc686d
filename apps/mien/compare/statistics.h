// Differences between two animations over matched frames.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "apps/mien/compare/matching.h"

namespace mien::app {

struct Extreme {
  double value = 0.0;
  double t_ms = 0.0;  // time in A
};

// For one control: over the frames in which both files have it. For `all`: over all such controls
// and frames; its correlation is the mean over controls.
struct Difference {
  std::size_t frames = 0;  // for `all`: controls x frames; 0: all values below are 0
  double mean_abs = 0.0;
  Extreme max_abs;
  std::optional<double> correlation;  // empty if A or B is constant
  double mean_a = 0.0, mean_b = 0.0;
  // The sum of |first difference| with a sign different from that of the previous frame, divided by
  // the number of frames.
  double jitter_a = 0.0, jitter_b = 0.0;
};

struct AngleDifference {
  double mean_abs_deg = 0.0;
  Extreme max_abs_deg;
};

// Over the frames in which both files have a head pose.
struct HeadDifference {
  std::size_t frames = 0;
  AngleDifference pitch, yaw, roll;
  AngleDifference rotation;  // the angle of the rotation between both heads
};

struct Differences {
  std::size_t matched_frames = 0;
  Difference all;
  std::size_t max_abs_control = 0;  // the control with the largest difference
  std::array<Difference, MIEN_CONTROL_COUNT> controls;
  HeadDifference head;
};

Differences differences(const Curves& a, const Curves& b, const std::vector<FramePair>& pairs);

// Jitter of values in order of time. NaN interrupts the curve.
double jitter(const std::vector<double>& values);

}  // namespace mien::app
