// A clip at even times, each face by itself, one frame after the other: never all in memory.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "formats/animation/resample.h"

namespace mien::app {

class EvenFrames {
 public:
  // Throws Failure(kExitUsage) for more than ten million frames, or 1000 faces, in the whole clip.
  EvenFrames(formats::FrameSequence frames, double fps);
  EvenFrames(const EvenFrames&) = delete;
  EvenFrames& operator=(const EvenFrames&) = delete;

  // In the order of their times, those of one time in the order of their faces; nothing at the end.
  [[nodiscard]] std::optional<formats::Frame> next();

 private:
  struct Face {
    formats::Resampler resampler;
    formats::Frame frame;  // its next
  };

  void split(formats::FrameSequence frames);
  void take_next(std::size_t face);
  [[nodiscard]] bool later(std::size_t a, std::size_t b) const;

  std::deque<formats::FrameSequence> parts_;  // of each face; resamplers refer to them
  std::deque<Face> faces_;
  std::vector<std::size_t> waiting_;  // faces that have a next frame: a heap, the earliest on top
};

}  // namespace mien::app
