// Parses commands of the page.
#include "apps/mien/live_page/command.h"

#include <array>
#include <nlohmann/json.hpp>

namespace mien::app {
namespace {

using nlohmann::json;
using Parsed = std::optional<PageCommand>;

constexpr std::size_t kMaxNameBytes = 512;

// The value of a key, or null if it is absent.
const json& value_of(const json& command, const char* key) {
  static const json kNull;
  const auto found = command.find(key);
  return found == command.end() ? kNull : *found;
}

Parsed missing(const char* key, const char* expected, std::string& fault) {
  fault = std::string(key) + ": expected " + expected;
  return std::nullopt;
}

Parsed parse_mirror(const json& command, std::string& fault) {
  const json& on = value_of(command, "on");
  return on.is_boolean() ? Parsed(SetMirror{on.get<bool>()})
                         : missing("on", "true or false", fault);
}

Parsed parse_level(const json& command, std::string& fault) {
  const json& level = value_of(command, "level");
  const bool is_valid = level.is_number_unsigned() && level.get<std::uint64_t>() <= 4;
  return is_valid ? Parsed(SetLevel{level.get<int>()}) : missing("level", "0 to 4", fault);
}

Parsed parse_neutral(const json& /*command*/, std::string& /*fault*/) { return CaptureNeutral{}; }

Parsed parse_save(const json& /*command*/, std::string& /*fault*/) { return SaveProfile{}; }

Parsed parse_sender(const json& command, std::string& fault) {
  const json& sender = value_of(command, "sender");
  const json& paused = value_of(command, "paused");
  if (!sender.is_number_unsigned()) {
    return missing("sender", "a number", fault);
  }
  return paused.is_boolean() ? Parsed(SetSender{sender.get<std::size_t>(), paused.get<bool>()})
                             : missing("paused", "true or false", fault);
}

template <class Command>
Parsed parse_device(const json& command, std::string& fault) {
  const json& name = value_of(command, "name");
  const bool is_valid =
      name.is_string() && name.get_ref<const std::string&>().size() <= kMaxNameBytes;
  return is_valid ? Parsed(Command{name.get<std::string>()}) : missing("name", "a device", fault);
}

Parsed parse_adjust(const json& command, std::string& fault) {
  const json& controls = value_of(command, "controls");
  if (!controls.is_array()) {
    return missing("controls", "an array", fault);
  }
  Adjust adjust;
  for (const json& item : controls) {
    const std::optional<ControlAdjustment> read = parse_adjustment(item, fault);
    if (!read) {
      return std::nullopt;
    }
    adjust.controls.push_back(*read);
  }
  return adjust;
}

struct Known {
  std::string_view name;
  Parsed (*parse)(const json& command, std::string& fault);
};

constexpr std::array<Known, 8> kCommands = {{{"mirror", parse_mirror},
                                             {"level", parse_level},
                                             {"neutral", parse_neutral},
                                             {"sender", parse_sender},
                                             {"camera", parse_device<SetCamera>},
                                             {"microphone", parse_device<SetMicrophone>},
                                             {"adjust", parse_adjust},
                                             {"save", parse_save}}};

}  // namespace

Parsed parse_command(std::string_view text, std::string& fault) {
  const json command = json::parse(text, nullptr, false);
  if (!command.is_object()) {
    fault = "not a JSON object";
    return std::nullopt;
  }
  for (const Known& known : kCommands) {
    if (value_of(command, "do") == known.name) {
      return known.parse(command, fault);
    }
  }
  return missing("do", "a known command", fault);
}

}  // namespace mien::app
