// Neutral calibration: captures a person's controls at rest and removes them from later frames.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tracker/decoders/controls.h"

namespace mien::tracker {

class Neutral {
 public:
  // Upper limit of a neutral value, so that a control keeps most of its range.
  static constexpr float kMax = 0.6f;

  [[nodiscard]] bool is_captured() const { return captured_; }
  [[nodiscard]] bool is_being_captured() const { return frame_ < kFrames; }
  [[nodiscard]] std::span<const float, kControls> levels() const { return levels_; }

  void set(std::span<const float, kControls> levels);
  void forget() {
    captured_ = false;
    frame_ = kFrames;
    levels_.fill(0.0f);
  }
  // Starts a capture with the next frame. When it is complete it replaces an earlier one.
  void capture() { frame_ = -kSettling; }
  // Restarts a running capture, because its frames so far are not usable.
  void restart() { frame_ = is_being_captured() ? -kSettling : kFrames; }
  // Cancels a running capture. An earlier one stays in effect.
  void cancel() { frame_ = kFrames; }

  // Adds one frame of controls to a running capture.
  void observe(std::span<const float, kControls> controls);
  // Maps the neutral value to 0 and 1 to 1, so that a blink keeps its range.
  void remove(std::span<float, kControls> controls) const {
    for (std::size_t i = 0; i < controls.size(); ++i) {
      controls[i] = std::max(0.0f, (controls[i] - levels_[i]) / (1.0f - levels_[i]));
    }
  }

 private:
  static constexpr std::int32_t kFrames = 45;    // long enough that blinks do not change the median
  static constexpr std::int32_t kSettling = 10;  // frames until the decoders have settled
  static constexpr float kSteps = 65535.0f;

  bool captured_ = false;
  std::int32_t frame_ = kFrames;  // of the capture; negative while settling
  std::array<float, kControls> levels_ = {};
  std::array<std::array<std::uint16_t, kFrames>, kControls> captured_frames_ =
      {};  // in units of 1 / kSteps
};

}  // namespace mien::tracker
