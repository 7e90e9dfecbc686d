// Prints JSON as valid UTF-8, whatever bytes file names contain.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mien::app {

// A negative `indent` prints one line.
[[nodiscard]] inline std::string json_text(const nlohmann::ordered_json& json, int indent = 1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace mien::app
