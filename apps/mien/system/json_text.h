// JSON that is printed: UTF-8 whatever the names of files hold.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mien::app {

// `indent` below 0: in one line.
[[nodiscard]] inline std::string json_text(const nlohmann::ordered_json& json, int indent = 1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace mien::app
