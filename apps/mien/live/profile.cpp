// Applies, reads and writes profiles.
#include "apps/mien/live/profile.h"

#include <mien/mien.h>

#include <algorithm>
#include <vector>

#include "apps/animation/base64.h"
#include "apps/mien/system/json_text.h"

namespace mien::app {
namespace {

constexpr int kVersion = 1;

// Leaves `value` unchanged if the key is absent. Returns false and sets `fault` if it is invalid.
bool read_number(const nlohmann::json& json, const char* key, double max, double& value,
                 std::string& fault) {
  const auto found = json.find(key);
  if (found == json.end()) {
    return true;
  }
  const bool is_valid =
      found->is_number() && found->get<double>() >= 0.0 && found->get<double>() <= max;
  if (!is_valid) {
    fault = std::string(key) + ": out of range (got " +
            found->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace).substr(0, 40) +
            ", expected 0 to " + nlohmann::json(max).dump() + ")";
    return false;
  }
  value = found->get<double>();
  return true;
}

bool read_neutral(const nlohmann::json& json, std::string& neutral, std::string& fault) {
  const auto found = json.find("neutral");
  if (found == json.end()) {
    return true;
  }
  if (!found->is_string() || !animation::parse_base64(found->get<std::string>(), neutral) ||
      neutral.size() != MIEN_NEUTRAL_BYTES) {
    fault = "neutral: not a neutral file in base64";
    return false;
  }
  return true;
}

bool read_controls(const nlohmann::json& json, Profile& profile, std::string& fault) {
  const auto found = json.find("controls");
  if (found == json.end()) {
    return true;
  }
  if (!found->is_array()) {
    fault = "controls: not an array";
    return false;
  }
  for (const nlohmann::json& item : *found) {
    const std::optional<ControlAdjustment> read = parse_adjustment(item, fault);
    if (!read) {
      return false;
    }
    profile.controls[read->control] = read->adjustment;
  }
  return true;
}

}  // namespace

double adjusted(double value, const Adjustment& adjustment) {
  if (!formats::driven(value)) {
    return value;
  }
  const double beyond = std::max(0.0, value - adjustment.dead_zone) / (1.0 - adjustment.dead_zone);
  return std::clamp(adjustment.gain * beyond, 0.0, 1.0);
}

animation::Frame Profile::applied(const animation::Frame& frame) const {
  animation::Frame result = frame;
  std::transform(frame.controls.begin(), frame.controls.end(), controls.begin(),
                 result.controls.begin(), adjusted);
  return result;
}

std::optional<ControlAdjustment> parse_adjustment(const nlohmann::json& json, std::string& fault) {
  const auto name = json.is_object() ? json.find("control") : json.end();
  if (!json.is_object() || name == json.end() || !name->is_string()) {
    fault = "control: missing";
    return std::nullopt;
  }
  ControlAdjustment result{formats::index_of(name->get<std::string>(), formats::kArkitNames), {}};
  if (result.control == formats::kControlCount) {
    fault = "control: unknown name (got '" + name->get<std::string>().substr(0, 40) + "')";
    return std::nullopt;
  }
  const bool is_valid =
      read_number(json, "gain", kMaxGain, result.adjustment.gain, fault) &&
      read_number(json, "dead_zone", kMaxDeadZone, result.adjustment.dead_zone, fault);
  return is_valid ? std::optional(result) : std::nullopt;
}

std::optional<Profile> parse_profile(std::string_view text, std::string& fault) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("mien_profile")) {
    fault = "not a profile";
    return std::nullopt;
  }
  if (json["mien_profile"] != kVersion) {
    fault = "mien_profile: unknown version (expected " + std::to_string(kVersion) + ")";
    return std::nullopt;
  }
  Profile profile;
  if (!read_neutral(json, profile.neutral, fault) || !read_controls(json, profile, fault)) {
    return std::nullopt;
  }
  return profile;
}

std::string profile_text(const Profile& profile) {
  nlohmann::ordered_json json;
  json["mien_profile"] = kVersion;
  if (!profile.neutral.empty()) {
    json["neutral"] = animation::base64(profile.neutral);
  }
  json["controls"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    const Adjustment& adjustment = profile.controls[i];
    if (adjustment.gain != 1.0 || adjustment.dead_zone != 0.0) {
      json["controls"].push_back({{"control", formats::kArkitNames[i]},
                                  {"gain", adjustment.gain},
                                  {"dead_zone", adjustment.dead_zone}});
    }
  }
  return json_text(json) + "\n";
}

}  // namespace mien::app
