// Interpolates frames.
#include "apps/animation/resample.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

double mixed(double a, double b, double fraction) {
  return formats::driven(a) && formats::driven(b) ? a + fraction * (b - a) : a;
}

template <class Values>
void mix(Values& values, const Values& next, double fraction) {
  for (std::size_t i = 0; i < values.size() && i < next.size(); ++i) {
    values[i] = mixed(values[i], next[i], fraction);
  }
}

Frame between_frames(const Frame& before, const Frame& after, double fraction) {
  Frame frame = before;
  if (fraction <= 0.0 || before.holds()) {
    return frame;
  }
  frame.face_probability = mixed(before.face_probability, after.face_probability, fraction);
  frame.voice_activity = mixed(before.voice_activity, after.voice_activity, fraction);
  mix(frame.controls, after.controls, fraction);
  mix(frame.facs, after.facs, fraction);
  mix(frame.visemes, after.visemes, fraction);
  if (before.box && after.box) {
    mix(*frame.box, *after.box, fraction);
  }
  if (before.position_m && after.position_m) {
    mix(*frame.position_m, *after.position_m, fraction);
  }
  if (before.head && after.head) {
    frame.head = between(*before.head, *after.head, fraction);
  }
  if (before.eyes && after.eyes) {
    for (std::size_t i = 0; i < 2; ++i) {
      (*frame.eyes)[i] = between((*before.eyes)[i], (*after.eyes)[i], fraction);
    }
  }
  return frame;
}

}  // namespace

Resampler::Resampler(const FrameSequence& frames, double fps, std::int64_t origin_ns)
    : frames_(frames), fps_(fps), origin_ns_(origin_ns), after_(frames.begin()) {
  if (frames.empty()) {
    return;
  }
  before_ = *after_;
  ++after_;
  const std::int64_t ahead_ns = frames.first_time_ns() - origin_ns;
  step_ = std::llround(static_cast<double>(ahead_ns) * 1e-9 * fps);
  step_ += since_origin(step_) < ahead_ns ? 1 : 0;
}

double Resampler::count(const FrameSequence& frames, double fps) {
  if (frames.empty()) {
    return 0.0;
  }
  const auto span_ns = static_cast<double>(frames.last_time_ns() - frames.first_time_ns());
  return span_ns * 1e-9 * fps + 1.0;
}

std::int64_t Resampler::since_origin(std::int64_t k) const {
  const double since = static_cast<double>(k) * 1e9 / fps_;
  return since < 0x1p63 ? std::llround(since) : std::numeric_limits<std::int64_t>::max();
}

std::optional<Frame> Resampler::next() {
  if (frames_.empty() || since_origin(step_) > frames_.last_time_ns() - origin_ns_) {
    return std::nullopt;
  }
  const std::int64_t time_ns = origin_ns_ + since_origin(step_);
  for (; after_ != FrameSequence::end() && after_->time_ns <= time_ns; ++after_) {
    before_ = *after_;
  }
  Frame frame = before_;
  if (after_ != FrameSequence::end()) {
    const auto gap = static_cast<double>(after_->time_ns - before_.time_ns);
    const auto since = static_cast<double>(time_ns - before_.time_ns);
    frame = between_frames(before_, *after_, gap > 0.0 ? since / gap : 0.0);
  }
  frame.number = step_++;
  frame.time_ns = time_ns;
  return frame;
}

FrameSequence resampled(const FrameSequence& frames, double fps, std::int64_t origin_ns) {
  FrameSequence result;
  Resampler resampler(frames, fps, origin_ns);
  while (const auto frame = resampler.next()) {
    result.push_back(*frame);
  }
  return result;
}

}  // namespace mien::animation
