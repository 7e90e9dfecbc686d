// What the keys of a glTF animation must satisfy.
#pragma once

#include <optional>

#include "apps/animation/frame_sequence.h"
#include "apps/animation/rotation.h"

namespace mien::animation {

// Times of keys: seconds from the first frame, which must increase as fp32.
class KeyTimes {
 public:
  explicit KeyTimes(const FrameSequence& frames)
      : first_ns_(frames.empty() ? 0 : frames.first_time_ns()) {}

  // Nothing if the time equals that of the previous key.
  [[nodiscard]] std::optional<float> next(const Frame& frame) {
    const auto second = static_cast<float>(static_cast<double>(frame.time_ns - first_ns_) * 1e-9);
    if (last_ && second <= *last_) {
      return std::nullopt;
    }
    last_ = second;
    return last_;
  }

 private:
  std::int64_t first_ns_;
  std::optional<float> last_;
};

// Rotations of a node, each with the sign nearest to the previous one, for interpolation.
class KeyRotations {
 public:
  [[nodiscard]] Quaternion next(Quaternion turn) {
    double same_way = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      same_way += turn[k] * before_[k];
    }
    for (double& part : turn) {
      part = same_way < 0.0 ? -part : part;
    }
    before_ = turn;
    return turn;
  }

 private:
  Quaternion before_ = {0.0, 0.0, 0.0, 1.0};
};

}  // namespace mien::animation
