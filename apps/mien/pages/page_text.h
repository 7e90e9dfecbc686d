// What is put into pages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace mien::app {

// JSON that can stand in a script element, whatever names are in it: nothing there ends the
// element.
std::string script_text(const nlohmann::ordered_json& json);

struct Insertion {
  std::string mark;  // "@DATA@"
  std::string text;
};

// The page with the texts in the places of their marks, which follow each other as they do in the
// page. Throws Failure(kExitInternal) when one is missing.
std::string filled(const char* page, const std::vector<Insertion>& insertions);

}  // namespace mien::app
