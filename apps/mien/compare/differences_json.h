// Differences as JSON, for the page and `mien compare --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/mien/compare/page.h"

namespace mien::app {

// Controls are a list in the order of the C API.
nlohmann::ordered_json differences_json(const Differences& differences);

// The summary of `mien compare --json`, described in docs/cli.md.
nlohmann::ordered_json summary_json(const Comparison& comparison);

}  // namespace mien::app
