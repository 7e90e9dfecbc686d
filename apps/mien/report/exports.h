// The animation in all formats, for download from a page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/animation/animation.h"

namespace mien::app {

struct Exports {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();  // docs/cli.md describes it
  std::string blocks;  // script elements with the compressed files
};

// The names of files are `stem` and the format's ending.
Exports exports_of(const std::vector<animation::Frame>& frames,
                   const animation::WriteOptions& writing, const std::string& stem);

// A script element with base64 text.
std::string block(const std::string& id, const std::string& base64);

}  // namespace mien::app
