// The animation in all formats, for download from a page.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/writer.h"

namespace mien::app {

struct Exports {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();  // docs/cli.md describes it
  std::string blocks;  // script elements with the compressed files
};

// The names of files are `stem` and the format's ending. `glb` writes the user's avatar; nullptr:
// mien's.
Exports exports_of(const std::vector<animation::Frame>& frames,
                   const animation::WriteOptions& writing, const std::string& stem,
                   std::unique_ptr<animation::AnimationWriter> glb);

// A script element with base64 text.
std::string block(const std::string& id, const std::string& base64);

}  // namespace mien::app
