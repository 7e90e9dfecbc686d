// `mien compare`: two files of curves go in, a page to judge them by comes out.
#pragma once

#include <string>

namespace mien::app {

struct CompareOptions {
  std::string a, b;
  std::string video;  // empty: none
  std::string page;
  bool json = false;  // the summary
  bool quiet = false;
};

// Throws Failure.
void compare(const CompareOptions& options);

}  // namespace mien::app
