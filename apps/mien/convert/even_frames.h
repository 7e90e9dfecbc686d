// Resamples a clip to even times. Faces are independent, and frames are computed one by one, so the
// result never occupies memory as a whole.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "apps/animation/resample.h"

namespace mien::app {

class EvenFrames {
 public:
  // Throws Failure(kExitUsage) for more than ten million frames in total, or 1000 faces.
  EvenFrames(animation::FrameSequence frames, double fps);
  EvenFrames(const EvenFrames&) = delete;
  EvenFrames& operator=(const EvenFrames&) = delete;

  // Returns frames in order of time, then of faces; nothing at the end.
  [[nodiscard]] std::optional<animation::Frame> next();

 private:
  struct Face {
    animation::Resampler resampler;
    animation::Frame frame;  // its next frame
  };

  void split(animation::FrameSequence frames);
  void take_next(std::size_t face);
  [[nodiscard]] bool later(std::size_t a, std::size_t b) const;

  std::deque<animation::FrameSequence> parts_;  // one per face; resamplers refer to them
  std::deque<Face> faces_;
  std::vector<std::size_t>
      heap_;  // a heap of the faces that have a next frame; the earliest is on top
};

}  // namespace mien::app
