// A clip at other times.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/animation/clip.h"

namespace mien::formats {

// Frames 1/fps apart, counted from `origin_ns`, which is a time that is allowed and not after the
// first frame, and from the first to the last frame; of one face. Values lie on the straight line
// between their neighbours, the head on the shorter way; what only one neighbour has, and states
// and mouth shapes, are those of the frame before. At the time of a frame stands that frame,
// exactly.
class Resampler {
 public:
  // `frames` has to outlive this.
  Resampler(const FrameSequence& frames, double fps, std::int64_t origin_ns);

  // The next one, which has as many steps behind it as its number says; nothing at the end.
  [[nodiscard]] std::optional<Frame> next();

  // How many next() will give at most; more than there are numbers for count as infinite.
  [[nodiscard]] static double count(const FrameSequence& frames, double fps);

 private:
  // Since the origin, of step k. All of a clip fits, but not all that may follow.
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

}  // namespace mien::formats
