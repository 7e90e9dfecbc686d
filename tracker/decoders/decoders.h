// The temporal decoders of one face: convert the features of both encoders over time to controls
// and head pose.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/arena.h"
#include "engine/network.h"
#include "tracker/decoders/controls_decoder.h"
#include "tracker/decoders/crossfade.h"
#include "tracker/decoders/neutral.h"
#include "tracker/encoders/levels.h"
#include "tracker/encoders/models.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

class Decoders {
 public:
  // Takes the networks' memory from `arena`, or only measures it if the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // Resets all decoders to the start of a stream and ends a crossfade: the level's decoder has full
  // weight.
  void reset(std::int32_t level);

  // Computes the controls of one frame. If the level has changed between 1 and the others, they
  // crossfade between the decoders within two seconds, and a running capture restarts with the new
  // decoder.
  void decode_controls(const Features& basenet, const Features& hifinet, std::int32_t level,
                       float seconds, std::span<float, kControls> controls);

  // The neutral calibration of the controls decoder that the level uses.
  [[nodiscard]] Neutral& neutral(std::int32_t level) {
    return level > kMinLevel ? hifinet_neutral_ : basenet_neutral_;
  }
  [[nodiscard]] const Neutral& neutral(std::int32_t level) const {
    return level > kMinLevel ? hifinet_neutral_ : basenet_neutral_;
  }

  // Leaves `pose` unchanged if the prediction is not a valid pose.
  void decode_pose(const Features& basenet, const Crop& crop, const Camera& camera, HeadPose& pose);

  // Bit i: the level's decoder predicts control i.
  [[nodiscard]] std::uint64_t supported_controls(std::int32_t level) const {
    return level > kMinLevel ? hifinet_controls_.supported() : basenet_controls_.supported();
  }
  // Bit i: a running decoder predicts control i; during a crossfade both run.
  [[nodiscard]] std::uint64_t active_controls() const {
    return (fade_.first_is_active() ? basenet_controls_.supported() : 0) |
           (fade_.second_is_active() ? hifinet_controls_.supported() : 0);
  }
  // Weight, 0..1, in the crossfade of those decoders that predict the control.
  [[nodiscard]] float supported_weight(std::size_t control) const;

 private:
  void transfer_capture(std::int32_t level);

  ControlsDecoder basenet_controls_;
  ControlsDecoder hifinet_controls_;
  Neutral basenet_neutral_;
  Neutral hifinet_neutral_;
  engine::Network pose_;
  Crossfade fade_;  // from BaseNet's to HiFiNet's controls
};

}  // namespace mien::tracker
