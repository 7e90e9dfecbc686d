// `mien bench`: time of each network, or of the tracker on a clip, on one core.
#pragma once

#include <string>

namespace mien::app {

struct BenchOptions {
  std::string model;  // empty: all
  std::string tier;   // empty: all this CPU has
  std::string models;
  std::string clip;  // empty: the networks
  bool json = false;
};

// Throws Failure.
void bench(const BenchOptions& options);

}  // namespace mien::app
