// Colours for terminals.
#pragma once

namespace mien::conformance {

struct Colours {
  const char *good = "", *bad = "", *faint = "", *end = "";
};

// Empty if standard output is not a terminal or NO_COLOR is set (https://no-color.org).
[[nodiscard]] const Colours& colours();

}  // namespace mien::conformance
