// Implements `mien neutral`, which captures neutral calibration from a video.
#pragma once

#include <optional>
#include <string>

namespace mien::app {

struct NeutralOptions {
  std::string input;
  std::string output;
  std::string models;
  double start_s = 0.0;
  std::optional<double> duration_s;
  bool json = false;  // print a summary as JSON
  bool quiet = false;
};

// Throws Failure.
void neutral(const NeutralOptions& options);

}  // namespace mien::app
