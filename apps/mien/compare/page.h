// The page of `mien compare`: one self-contained HTML file.
#pragma once

#include <string>

#include "apps/mien/compare/statistics.h"

namespace mien::app {

struct ComparedFile {
  std::string name;
  Curves curves;
};

struct Comparison {
  ComparedFile a, b;
  Differences differences;
  double start_ms = 0.0, end_ms = 0.0;  // the time range that the page plays
  std::string video;                    // MP4 that starts at start_ms; empty: none
};

// Throws Failure(kExitInternal) if the embedded page is incomplete.
std::string compare_page(const Comparison& comparison);

}  // namespace mien::app
