// Times and memory limits of clips.
#include "apps/animation/clip.h"

#include <cmath>
#include <cstddef>

namespace mien::animation {

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
  // A double represents nanoseconds exactly up to 104 days. For larger times, milliseconds and the
  // remainder are exact, and their sum is rounded once.
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  if (time_ns >= -kExact && time_ns <= kExact) {
    return static_cast<double>(time_ns) / static_cast<double>(kMillisecond_ns);
  }
  const std::int64_t whole = time_ns / kMillisecond_ns, rest_ns = time_ns % kMillisecond_ns;
  return static_cast<double>(whole) +
         static_cast<double>(rest_ns) / static_cast<double>(kMillisecond_ns);
}

bool time_of(double units, std::int64_t unit_ns, std::int64_t& time_ns) {
  const std::int64_t max_units = kLastTime_ns / unit_ns;
  const double whole = std::trunc(units);
  if (!(std::abs(whole) <= static_cast<double>(max_units))) {  // also rejects NaN
    return false;
  }
  const std::int64_t rest = std::llround((units - whole) * static_cast<double>(unit_ns));
  const std::int64_t time = static_cast<std::int64_t>(whole) * unit_ns + rest;
  time_ns = time_allowed(time) ? time : time_ns;
  return time_allowed(time);
}

double mean_step_s(std::int64_t first_ns, std::int64_t last_ns, std::size_t frames) {
  if (frames < 2 || last_ns == first_ns) {
    return 1.0 / 30.0;
  }
  return static_cast<double>(last_ns - first_ns) * 1e-9 / static_cast<double>(frames - 1);
}

double mean_step_s(const FrameSequence& frames) {
  return frames.empty() ? mean_step_s(0, 0, 0)
                        : mean_step_s(frames.first_time_ns(), frames.last_time_ns(), frames.size());
}

bool evenly_spaced(const FrameSequence& frames) {
  const double step_ns = mean_step_s(frames) * 1e9;
  std::size_t i = 0;
  for (const Frame& frame : frames) {
    const auto since = static_cast<double>(frame.time_ns - frames.first_time_ns());
    if (std::abs(since - static_cast<double>(i++) * step_ns) > 0.5e6) {
      return false;
    }
  }
  return true;
}

std::size_t max_clip_bytes(std::size_t input_bytes) {
  constexpr std::size_t kAlways = std::size_t{40} << 20, kInputs = 4;
  return kAlways + kInputs * input_bytes;
}

bool add_frame(Clip& clip, const Frame& frame, std::size_t line, Fault& fault) {
  return clip.frames.add(frame) ||
         fail(fault, line, 1, "the frames take too much memory for a file of this size");
}

}  // namespace mien::animation
