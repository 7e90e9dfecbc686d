#include "formats/animation/resample.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "formats/animation/rotation.h"

namespace mien::formats {
namespace {

double mixed(double a, double b, double share) {
  return driven(a) && driven(b) ? a + share * (b - a) : a;
}

template <class Values>
void mix(Values& values, const Values& next, double share) {
  for (std::size_t i = 0; i < values.size() && i < next.size(); ++i) {
    values[i] = mixed(values[i], next[i], share);
  }
}

Frame between_frames(const Frame& before, const Frame& after, double share) {
  Frame frame = before;
  if (share <= 0.0 || before.mouth_shape != 0) {
    return frame;
  }
  frame.face_probability = mixed(before.face_probability, after.face_probability, share);
  frame.voice_activity = mixed(before.voice_activity, after.voice_activity, share);
  mix(frame.controls, after.controls, share);
  mix(frame.facs, after.facs, share);
  mix(frame.visemes, after.visemes, share);
  if (before.box && after.box) {
    mix(*frame.box, *after.box, share);
  }
  if (before.position_m && after.position_m) {
    mix(*frame.position_m, *after.position_m, share);
  }
  if (before.head && after.head) {
    frame.head = between(*before.head, *after.head, share);
  }
  if (before.eyes && after.eyes) {
    for (std::size_t i = 0; i < 2; ++i) {
      (*frame.eyes)[i] = between((*before.eyes)[i], (*after.eyes)[i], share);
    }
  }
  return frame;
}

}  // namespace

std::vector<Frame> resampled(const std::vector<Frame>& frames, double fps, std::int64_t origin_ns) {
  std::vector<Frame> made;
  if (frames.empty()) {
    return made;
  }
  // Since the origin. All of a clip fits, but not all that may follow.
  const auto since_origin = [&](std::int64_t k) -> std::int64_t {
    const double since = static_cast<double>(k) * 1e9 / fps;
    return since < 0x1p63 ? std::llround(since) : std::numeric_limits<std::int64_t>::max();
  };
  const std::int64_t ahead_ns = frames.front().time_ns - origin_ns;
  std::int64_t first = std::llround(static_cast<double>(ahead_ns) * 1e-9 * fps);
  first += since_origin(first) < ahead_ns ? 1 : 0;
  std::size_t before = 0;
  for (std::int64_t k = first;; ++k) {
    if (since_origin(k) > frames.back().time_ns - origin_ns) {
      return made;
    }
    const std::int64_t time_ns = origin_ns + since_origin(k);
    while (before + 1 < frames.size() && frames[before + 1].time_ns <= time_ns) {
      ++before;
    }
    const std::size_t after = before + 1 < frames.size() ? before + 1 : before;
    const auto gap = static_cast<double>(frames[after].time_ns - frames[before].time_ns);
    const auto since = static_cast<double>(time_ns - frames[before].time_ns);
    Frame frame = between_frames(frames[before], frames[after], gap > 0.0 ? since / gap : 0.0);
    frame.number = k;
    frame.time_ns = time_ns;
    made.push_back(std::move(frame));
  }
}

}  // namespace mien::formats
