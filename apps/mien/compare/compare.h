// Implements `mien compare`, which creates a page to compare two animations.
#pragma once

#include <string>

namespace mien::app {

struct CompareOptions {
  std::string a, b;
  std::string video;  // empty: none
  std::string page;
  bool json = false;  // print the summary
  bool quiet = false;
};

// Throws Failure.
void compare(const CompareOptions& options);

}  // namespace mien::app
