// opentrack's input "UDP over network", port 4242: six little-endian doubles.
#pragma once

#include <string>

#include "apps/animation/clip.h"

namespace mien::protocols {

// x, y, z in centimetres, yaw, pitch, roll in degrees, with the directions of camera space
// (clip.h); zeros for a frame without a head.
[[nodiscard]] std::string opentrack_packet(const animation::Frame& frame);

}  // namespace mien::protocols
