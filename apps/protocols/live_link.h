// Packets of Live Link Face, version 6: UDP port 11111, big-endian. Epic does not document them;
// the layout follows captured packets.
#pragma once

#include <string>

#include "apps/animation/clip.h"
#include "apps/animation/live_link_csv.h"

namespace mien::protocols {

struct LiveLinkSubject {
  std::string device_id;  // 36 characters, a UUID
  std::string name;       // displayed by Unreal, UTF-8
  animation::RotationUnit rotation = animation::RotationUnit::kRadians;
};

// `time_s` is the time of day; the packet contains it as a 32-bit frame number at 60 per second. A
// blank frame has count 0.
[[nodiscard]] std::string live_link_packet(const animation::Frame& frame,
                                           const LiveLinkSubject& subject, double time_s);

}  // namespace mien::protocols
