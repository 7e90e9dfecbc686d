// Writes opentrack packets.
#include "apps/protocols/opentrack.h"

#include <numbers>

#include "apps/protocols/bytes.h"

namespace mien::protocols {

std::string opentrack_packet(const animation::Frame& frame) {
  constexpr double kCentimetres = 100.0, kDegrees = 180.0 / std::numbers::pi;
  std::string packet;
  for (const double metres : frame.position_m.value_or(std::array<double, 3>{})) {
    append_little_double(packet, kCentimetres * metres);
  }
  const animation::Angles head = frame.head.value_or(animation::Angles());
  for (const double angle : {head.yaw, head.pitch, head.roll}) {
    append_little_double(packet, kDegrees * angle);
  }
  return packet;
}

}  // namespace mien::protocols
