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

double Frame::time_ms() const {
  // A double has room for the nanoseconds of 104 days. Of more, milliseconds and what is left do,
  // and their sum is rounded once.
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  if (time_ns >= -kExact && time_ns <= kExact) {
    return static_cast<double>(time_ns) / static_cast<double>(kMillisecond_ns);
  }
  const std::int64_t whole = time_ns / kMillisecond_ns, rest_ns = time_ns % kMillisecond_ns;
  return static_cast<double>(whole) +
         static_cast<double>(rest_ns) / static_cast<double>(kMillisecond_ns);
}

bool time_of(double units, std::int64_t unit_ns, std::int64_t& time_ns) {
  const std::int64_t most = kLastTime_ns / unit_ns;
  const double whole = std::trunc(units);
  if (!(std::abs(whole) <= static_cast<double>(most))) {  // nor is a NaN a time
    return false;
  }
  const std::int64_t rest = std::llround((units - whole) * static_cast<double>(unit_ns));
  const std::int64_t time = static_cast<std::int64_t>(whole) * unit_ns + rest;
  time_ns = time_allowed(time) ? time : time_ns;
  return time_allowed(time);
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
