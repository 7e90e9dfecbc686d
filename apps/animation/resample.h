// Resamples a clip to even times.
#pragma once

#include <cstdint>
#include <optional>

#include "apps/animation/clip.h"

namespace mien::animation {

// Frames of one face, 1/fps apart, counted from `origin_ns`, which must be allowed and not after
// the first frame, and between the first and the last frame. Values are interpolated linearly,
// rotations along the shorter way. Data that only one neighbour has, states and mouth shapes are
// those of the frame before. At the time of a frame, the result equals that frame.
class Resampler {
 public:
  // `frames` must outlive this.
  Resampler(const FrameSequence& frames, double fps, std::int64_t origin_ns);

  // The next frame, whose number is its number of steps from the origin; nothing at the end.
  [[nodiscard]] std::optional<Frame> next();

  // The maximum number of frames of next(); infinity if it is too large for frame numbers.
  [[nodiscard]] static double count(const FrameSequence& frames, double fps);

 private:
  // Time of step k since the origin. Valid for all frames of a clip, but steps after it may
  // overflow.
  [[nodiscard]] std::int64_t since_origin(std::int64_t k) const;

  const FrameSequence& frames_;
  double fps_;
  std::int64_t origin_ns_;
  std::int64_t step_ = 0;
  FrameSequence::Iterator after_;
  Frame before_;
};

[[nodiscard]] FrameSequence resampled(const FrameSequence& frames, double fps,
                                      std::int64_t origin_ns);

}  // namespace mien::animation
