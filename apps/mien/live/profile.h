// A person's calibration for `mien live`: neutral values, and a gain and a dead zone per control.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "apps/animation/frame.h"

namespace mien::app {

struct Adjustment {
  double gain = 1.0;       // 0..kMaxGain
  double dead_zone = 0.0;  // 0..kMaxDeadZone; values up to it become 0
};
inline constexpr double kMaxGain = 4.0;
inline constexpr double kMaxDeadZone = 0.9;

struct ControlAdjustment {
  std::size_t control;  // in the order of kArkitNames
  Adjustment adjustment;
};

// gain * (value - dead_zone) / (1 - dead_zone), limited to 0..1. NaN stays NaN.
[[nodiscard]] double adjusted(double value, const Adjustment& adjustment);

struct Profile {
  std::array<Adjustment, formats::kControlCount> controls;
  std::string neutral;  // content of a neutral file; empty: none

  [[nodiscard]] animation::Frame applied(const animation::Frame& frame) const;
};

// Reads {"control":"jawOpen","gain":1.5,"dead_zone":0.1}; gain and dead_zone may be absent. Returns
// nothing and sets `fault` if it is invalid.
std::optional<ControlAdjustment> parse_adjustment(const nlohmann::json& json, std::string& fault);

// Returns nothing and sets `fault` if the text is not a profile.
std::optional<Profile> parse_profile(std::string_view text, std::string& fault);
[[nodiscard]] std::string profile_text(const Profile& profile);

}  // namespace mien::app
