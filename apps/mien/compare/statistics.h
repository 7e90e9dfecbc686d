// How two files of curves differ. Everything is over matched frames.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "apps/mien/compare/matching.h"

namespace mien::app {

struct Extreme {
  double value = 0.0;
  double t_ms = 0.0;  // of the frame of A
};

// Of one control: over the frames where both files drive it. Of all: over the controls and frames
// where both do; the correlation is then the mean of the controls that have one.
struct Difference {
  std::size_t frames = 0;  // of all: controls x frames. 0: everything below is 0
  double mean_abs = 0.0;
  Extreme max_abs;
  std::optional<double> correlation;  // nothing where A or B does not move
  double mean_a = 0.0, mean_b = 0.0;
  // Sum of |first difference| where its sign differs from the previous frame's, over the frames.
  double jitter_a = 0.0, jitter_b = 0.0;
};

struct AngleDifference {
  double mean_abs_deg = 0.0;
  Extreme max_abs_deg;
};

// Over the frames where both files have a head pose.
struct HeadDifference {
  std::size_t frames = 0;
  AngleDifference pitch, yaw, roll;
  AngleDifference rotation;  // the angle of the one rotation that takes A's head to B's
};

struct Differences {
  std::size_t matched_frames = 0;
  Difference all;
  std::size_t max_abs_control = 0;  // where `all` is largest
  std::array<Difference, MIEN_CONTROL_COUNT> controls;
  HeadDifference head;
};

Differences differences(const Curves& a, const Curves& b, const std::vector<FramePair>& pairs);

// Of values in the order of time; NaN interrupts the stream, as a frame without a value does.
double jitter(const std::vector<double>& values);

}  // namespace mien::app
