// The temporal decoders of one face: features of both encoders, over time, to controls and head
// pose.
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
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, std::uint32_t cpu_mask,
                                 engine::Arena& arena);

  // A new stream begins, at once with the decoder that the level asks for.
  void reset(std::int32_t level);

  // One step, for one frame of output. When the level has changed between 1 and the others the
  // controls go over from one decoder to the other within two seconds, and a capture of what is
  // neutral begins anew with the other.
  void decode_controls(const Features& basenet, const Features& hifinet, std::int32_t level,
                       float seconds, std::span<float, kControls> controls);

  // What the face shows at rest, as each of the controls decoders sees it.
  [[nodiscard]] Neutral& neutral(std::int32_t level) {
    return level > kLowestLevel ? hifinet_neutral_ : basenet_neutral_;
  }
  [[nodiscard]] const Neutral& neutral(std::int32_t level) const {
    return level > kLowestLevel ? hifinet_neutral_ : basenet_neutral_;
  }

  // A prediction that is no pose leaves `pose` as it was.
  void decode_pose(const Features& basenet, const Crop& crop, const Camera& camera, HeadPose& pose);

  // Bit i: the level drives control i.
  [[nodiscard]] std::uint64_t supported_controls(std::int32_t level) const {
    return level > kLowestLevel ? hifinet_controls_.supported() : basenet_controls_.supported();
  }
  // Bit i: a decoder that is heard drives control i; while one hands over to the other both are.
  [[nodiscard]] std::uint64_t active_controls() const {
    return (fade_.first_is_active() ? basenet_controls_.supported() : 0) |
           (fade_.second_is_active() ? hifinet_controls_.supported() : 0);
  }
  // How much of a control comes from decoders that drive it, 0..1.
  [[nodiscard]] float supported_share(std::size_t control) const;

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
