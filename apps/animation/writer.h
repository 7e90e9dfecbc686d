// An interface for writers, frame by frame.
#pragma once

#include <string>

#include "apps/animation/clip.h"

namespace mien::animation {

class AnimationWriter {
 public:
  virtual ~AnimationWriter() = default;

  // Each function returns bytes to append to the file; empty if the writer needs more frames.
  [[nodiscard]] virtual std::string begin() { return {}; }
  [[nodiscard]] virtual std::string frame(const Frame& frame) = 0;
  [[nodiscard]] virtual std::string finish() { return {}; }
};

// For formats that need all frames before their first byte.
class WholeClipWriter : public AnimationWriter {
 public:
  [[nodiscard]] std::string frame(const Frame& frame) final {
    frames_.push_back(frame);
    return {};
  }
  [[nodiscard]] std::string finish() final { return whole(frames_); }

 protected:
  [[nodiscard]] virtual std::string whole(const FrameSequence& frames) = 0;

 private:
  FrameSequence frames_;
};

}  // namespace mien::animation
