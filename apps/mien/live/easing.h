// What is shown of a face that comes and goes: it never jumps.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/animation/clip.h"

namespace mien::app {

// A lost face is held for half a second and then eases within a second to what the tracker says
// without one: its mouth as the sound has it, everything else at rest, the head straight where it
// was last. A face that is found again is eased to within a fifth of a second.
class Easing {
 public:
  Easing() { shown_.state = formats::FaceState::kSearching; }
  // Frames in the order of their times.
  formats::Frame next(const formats::Frame& tracked);

 private:
  void change(formats::FaceState state, std::int64_t now_ns);
  [[nodiscard]] double share(std::int64_t now_ns) const;

  std::optional<formats::Frame> from_;  // what was shown when the state changed
  formats::Frame shown_;                // before any: of a face that is searched
  bool seen_ = false;                   // there was a face
  std::int64_t changed_ns_ = 0;
};

}  // namespace mien::app
