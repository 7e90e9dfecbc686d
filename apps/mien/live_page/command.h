// Commands of the page to `mien live`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "apps/mien/live/profile.h"

namespace mien::app {

struct SetMirror {
  bool mirror;
};
struct SetLevel {
  int level;  // 0: automatic
};
struct CaptureNeutral {};
struct SetSender {
  std::size_t sender;  // in the order of --send
  bool paused;
};
struct SetCamera {
  std::string name;
};
struct SetMicrophone {
  std::string name;
};
struct Adjust {
  std::vector<ControlAdjustment> controls;
};
struct SaveProfile {};

using PageCommand = std::variant<SetMirror, SetLevel, CaptureNeutral, SetSender, SetCamera,
                                 SetMicrophone, Adjust, SaveProfile>;

// Parses {"do":"NAME", ...}. Returns nothing and sets `fault` if the text is not a command.
std::optional<PageCommand> parse_command(std::string_view text, std::string& fault);

}  // namespace mien::app
