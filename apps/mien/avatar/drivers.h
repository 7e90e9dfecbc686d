// Drivers of an avatar's morph targets and expressions, found by their names: those of ARKit,
// Roblox, visemes and VRM, with prefixes and the spellings that avatars use.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "apps/animation/frame.h"

namespace mien::app {

// The mean of two values of a vocabulary, which may be the same.
struct Driver {
  int vocabulary = 0;  // a mien_vocabulary
  std::array<std::size_t, 2> values = {};
};

using Drivers = std::map<std::string, Driver>;  // by name in the avatar

// Visemes and the vowels of VRM move the mouth only if no name of ARKit or Roblox opens the jaw.
[[nodiscard]] Drivers morph_drivers(const std::vector<std::string>& names);

// For the expressions of a VRM: ARKit's names if it has them, otherwise the presets.
[[nodiscard]] Drivers expression_drivers(const std::vector<std::string>& names);

// The values of a frame in all vocabularies. Unsupported controls are 0.
class DriverValues {
 public:
  explicit DriverValues(const animation::Frame& frame);
  [[nodiscard]] double of(const Driver& driver) const;

 private:
  std::vector<std::vector<float>> values_;  // [vocabulary][name]
};

}  // namespace mien::app
