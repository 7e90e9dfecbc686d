// Colours, where somebody sees them.
#pragma once

namespace mien::conformance {

struct Colours {
  const char *good = "", *bad = "", *faint = "", *end = "";
};

// None when standard output is no terminal, or NO_COLOR is set (https://no-color.org).
[[nodiscard]] const Colours& colours();

}  // namespace mien::conformance
