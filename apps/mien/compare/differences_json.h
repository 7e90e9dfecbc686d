// Differences as JSON, of the page and of `mien compare --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/mien/compare/page.h"

namespace mien::app {

// Controls are a list in the order of the C API.
nlohmann::ordered_json differences_json(const Differences& differences);

// What docs/cli.md says of `mien compare --json`.
nlohmann::ordered_json summary_json(const Comparison& comparison);

}  // namespace mien::app
