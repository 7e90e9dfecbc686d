// Smooth transitions when a face is lost or found.
#pragma once

#include <cstdint>
#include <optional>

#include "apps/animation/clip.h"

namespace mien::app {

// Holds a lost face for half a second, then eases within a second to the tracker's output without a
// face: the mouth follows the audio, other controls rest, and the head is straight at its last
// position. When a face is found, eases to it within a fifth of a second.
class Easing {
 public:
  Easing() { output_.state = animation::FaceState::kSearching; }
  // Returns the frame to display. Frames must be in order of time.
  animation::Frame next(const animation::Frame& tracked);

 private:
  void change(animation::FaceState state, std::int64_t now_ns);
  [[nodiscard]] double progress(std::int64_t now_ns) const;

  std::optional<animation::Frame> from_;  // the output when the state changed
  animation::Frame output_;               // the last output; searching before the first
  bool had_face_ = false;                 // a face was tracked before
  std::int64_t changed_ns_ = 0;
};

}  // namespace mien::app
