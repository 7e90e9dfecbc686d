// The 52 controls: ARKit's names in the order of Apple's Live Link wire format. Left and right are
// the subject's.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "formats/vocabulary/vocabulary.h"

namespace mien::tracker {

inline constexpr int kControls = static_cast<int>(formats::kControlCount);

// Null-terminated, because the names are literals.
inline constexpr std::array<const char*, kControls> kControlNames = [] {
  std::array<const char*, kControls> names{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = formats::kArkitNames[i].data();
  }
  return names;
}();

consteval std::size_t control_named(std::string_view name) {
  std::size_t i = 0;
  while (kControlNames[i] != name) {
    ++i;
  }
  return i;
}

}  // namespace mien::tracker
