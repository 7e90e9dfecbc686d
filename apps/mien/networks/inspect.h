// Implements `mien inspect`, which prints the content of a weight file.
#pragma once

#include <string>

namespace mien::app {

struct InspectOptions {
  std::string file;
  bool json = false;
};

// Throws Failure.
void inspect(const InspectOptions& options);

}  // namespace mien::app
