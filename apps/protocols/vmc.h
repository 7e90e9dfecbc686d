// VMC protocol 3.1 in the role of the performer (protocol.vmc.info): OSC over UDP, port 39539.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/clip.h"

namespace mien::protocols {

struct NamedValue {
  std::string_view name;  // name of the avatar's expression, case-sensitive
  double value = 0.0;     // 0..1
};

struct VmcFrame {
  double seconds = 0.0;                   // since the sender started
  bool tracking = false;                  // a face is tracked
  std::span<const NamedValue> blends;     // take effect together
  std::optional<animation::Angles> head;  // head to camera
};

// Datagrams of at most 1500 bytes, to be sent in this order: /VMC/Ext/OK, /VMC/Ext/T, the bone
// Head, the blends, and /VMC/Ext/Blend/Apply at the end of the last. The rotation of the head is in
// Unity's left-handed space (x to the avatar's right, y up, z out of the face); its position,
// relative to the avatar's neck, stays 0.
[[nodiscard]] std::vector<std::string> vmc_packets(const VmcFrame& frame);

}  // namespace mien::protocols
