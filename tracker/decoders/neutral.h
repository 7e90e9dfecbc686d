// What a person's face shows at rest: captured once, and taken out of the controls from then on.
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
  // Of a rest that is taken out.
  static constexpr float kLargest = 0.6f;

  [[nodiscard]] bool is_captured() const { return captured_; }
  [[nodiscard]] bool is_being_captured() const { return frame_ < kFrames; }
  [[nodiscard]] std::span<const float, kControls> levels() const { return levels_; }

  void set(std::span<const float, kControls> levels);
  void forget() {
    captured_ = false;
    frame_ = kFrames;
    levels_.fill(0.0f);
  }
  // From the next frames on; replaces what was captured before, as soon as it is done.
  void capture() { frame_ = -kSettling; }
  // What was seen so far is of no use: a capture that is going on begins anew.
  void restart() { frame_ = is_being_captured() ? -kSettling : kFrames; }
  // A capture that is going on is given up; what was captured before stays.
  void give_up() { frame_ = kFrames; }

  // One frame of controls; of use only while it is being captured.
  void observe(std::span<const float, kControls> controls);
  // The rest becomes 0, and 1 stays 1, so that a blink keeps its range.
  void take_out(std::span<float, kControls> controls) const {
    for (std::size_t i = 0; i < controls.size(); ++i) {
      controls[i] = std::max(0.0f, (controls[i] - levels_[i]) / (1.0f - levels_[i]));
    }
  }

 private:
  static constexpr std::int32_t kFrames = 45;    // so that a blink or two do not count
  static constexpr std::int32_t kSettling = 10;  // of the decoders
  static constexpr float kSteps = 65535.0f;

  bool captured_ = false;
  std::int32_t frame_ = kFrames;  // of a measurement
  std::array<float, kControls> levels_ = {};
  std::array<std::array<std::uint16_t, kFrames>, kControls> seen_ = {};  // in kSteps of one
};

}  // namespace mien::tracker
