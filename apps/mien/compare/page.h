// The page of `mien compare`: one HTML file that needs nothing else.
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
  double start_ms = 0.0, end_ms = 0.0;  // of the time that the page plays
  std::string video;                    // MP4 whose time 0 is start_ms; empty: none
};

// Throws Failure(kExitInternal) when the page built into the program is not whole.
std::string compare_page(const Comparison& comparison);

}  // namespace mien::app
