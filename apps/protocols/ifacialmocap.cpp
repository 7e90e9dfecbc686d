// Formats iFacialMocap packets.
#include "apps/protocols/ifacialmocap.h"

#include <cmath>
#include <numbers>

#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"

namespace mien::protocols {
namespace {

constexpr std::string_view kVersion2 = "|sendDataVersion=v2";
constexpr int kDegreeDecimals = 4, kMetreDecimals = 6;

// "eyeBlink_L" for eyeBlinkLeft; jawLeft and mouthLeft are directions, not sides, and stay
// unchanged.
std::string name_of(std::string_view arkit) {
  for (const std::string_view side : {std::string_view("Left"), std::string_view("Right")}) {
    const std::string_view stem =
        arkit.substr(0, arkit.size() - std::min(arkit.size(), side.size()));
    if (arkit.ends_with(side) && stem != "jaw" && stem != "mouth") {
      return std::string(stem) + '_' + side[0];
    }
  }
  return std::string(arkit);
}

std::string rotation_text(const animation::Angles& angles) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return animation::fixed(kDegrees * angles.pitch, kDegreeDecimals) + "," +
         animation::fixed(kDegrees * (0.0 - angles.yaw), kDegreeDecimals) + "," +
         animation::fixed(kDegrees * angles.roll, kDegreeDecimals);
}

}  // namespace

std::optional<char> ifacialmocap_separator(std::string_view datagram) {
  if (!datagram.starts_with(kIfacialmocapHello)) {
    return std::nullopt;
  }
  const std::string_view rest = datagram.substr(kIfacialmocapHello.size());
  return rest.empty() ? std::optional('-') : rest == kVersion2 ? std::optional('&') : std::nullopt;
}

std::string ifacialmocap_text(const animation::Frame& frame, char separator) {
  std::string text;
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    text.append(name_of(formats::kArkitNames[i])) += separator;
    text.append(std::to_string(std::lround(100.0 * formats::or_zero(frame.controls[i])))) += '|';
  }
  const auto eyes = frame.eyes ? frame.eyes : animation::gaze(frame.controls);
  text.append("=head#").append(rotation_text(frame.head.value_or(animation::Angles())));
  for (const double metres : frame.position_m.value_or(std::array<double, 3>{})) {
    text.append(",").append(animation::fixed(metres, kMetreDecimals));
  }
  text.append("|rightEye#").append(rotation_text(eyes ? (*eyes)[1] : animation::Angles()));
  text.append("|leftEye#").append(rotation_text(eyes ? (*eyes)[0] : animation::Angles()));
  return text + "|";
}

}  // namespace mien::protocols
