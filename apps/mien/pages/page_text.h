// Inserts data into pages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace mien::app {

// JSON for a script element. It is escaped, so that no text in it ends the element.
std::string script_text(const nlohmann::ordered_json& json);

struct Insertion {
  std::string mark;  // "@DATA@"
  std::string text;
};

// Replaces marks with texts. The marks must be in the order in which they occur in the page. Throws
// Failure(kExitInternal) if one is missing.
std::string filled(const char* page, const std::vector<Insertion>& insertions);

}  // namespace mien::app
