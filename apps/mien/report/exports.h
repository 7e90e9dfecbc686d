// The animation in every format there is, for a page to offer.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/animation/animation.h"

namespace mien::app {

struct Exports {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();  // docs/cli.md describes it
  std::string blocks;  // script elements that hold the files, packed
};

// Files are called `stem` and their format's ending.
Exports exports_of(const std::vector<formats::Frame>& frames, const formats::WriteOptions& writing,
                   const std::string& stem);

// A script element that holds text; the text is base64.
std::string block(const std::string& id, const std::string& base64);

}  // namespace mien::app
