#include "formats/animation/clip.h"

#include <cmath>
#include <cstddef>

namespace mien::formats {

const char* name(FaceState state) {
  switch (state) {
    case FaceState::kSearching:
      return "searching";
    case FaceState::kTracking:
      return "tracking";
    case FaceState::kLost:
      return "lost";
  }
  return "";
}

double mean_step_s(const std::vector<Frame>& frames) {
  if (frames.size() < 2 || frames.back().time_ns == frames.front().time_ns) {
    return 1.0 / 30.0;
  }
  const auto span = static_cast<double>(frames.back().time_ns - frames.front().time_ns);
  return span * 1e-9 / static_cast<double>(frames.size() - 1);
}

bool evenly_spaced(const std::vector<Frame>& frames) {
  const double step_ns = mean_step_s(frames) * 1e9;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto since = static_cast<double>(frames[i].time_ns - frames.front().time_ns);
    if (std::abs(since - static_cast<double>(i) * step_ns) > 0.5e6) {
      return false;
    }
  }
  return true;
}

}  // namespace mien::formats
