// Live Link Face's packets, version 6: UDP port 11111, big-endian. Epic documents none of it; the
// layout is that of captured packets.
#pragma once

#include <string>

#include "formats/animation/clip.h"
#include "formats/animation/live_link_csv.h"

namespace mien::formats {

struct LiveLinkSubject {
  std::string device_id;  // 36 characters, a UUID
  std::string name;       // how Unreal lists it, UTF-8
  RotationUnit rotation = RotationUnit::kRadians;
};

// `time_s`: of the day, which becomes a frame's number at 60 a second, of at most 32 bits. A frame
// that shows nothing says so with a count of 0.
[[nodiscard]] std::string live_link_packet(const Frame& frame, const LiveLinkSubject& subject,
                                           double time_s);

}  // namespace mien::formats
