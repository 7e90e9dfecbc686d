// Writes Live Link Face packets.
#include "apps/protocols/live_link.h"

#include <cmath>

#include "apps/protocols/bytes.h"

namespace mien::protocols {
namespace {

constexpr std::uint8_t kVersion = 6;
constexpr std::uint32_t kFramesPerSecond = 60;
constexpr std::uint8_t kValues = formats::kControlCount + formats::kRotationCount;

void append_text(std::string& packet, const std::string& text) {
  append_big(packet, static_cast<std::uint32_t>(text.size()));
  packet += text;
}

void append_frame_time(std::string& packet, double time_s) {
  constexpr double kAllFrames = 4294967296.0;
  const double frames = std::fmod(std::fmax(time_s, 0.0) * kFramesPerSecond, kAllFrames);
  const double whole = std::floor(frames);
  append_big(packet, static_cast<std::uint32_t>(whole));
  append_big_float(packet, frames - whole);
  append_big(packet, kFramesPerSecond);
  append_big(packet, std::uint32_t{1});  // denominator of the frame rate
}

}  // namespace

std::string live_link_packet(const animation::Frame& frame, const LiveLinkSubject& subject,
                             double time_s) {
  std::string packet;
  append_big(packet, kVersion);
  append_text(packet, subject.device_id);
  append_text(packet, subject.name);
  append_frame_time(packet, time_s);
  if (animation::is_blank(frame)) {
    append_big(packet, std::uint8_t{0});
    return packet;
  }
  append_big(packet, kValues);
  for (const double control : frame.controls) {
    append_big_float(packet, formats::or_zero(control));
  }
  for (const double rotation : animation::live_link_rotations(frame, subject.rotation)) {
    append_big_float(packet, rotation);
  }
  return packet;
}

}  // namespace mien::protocols
