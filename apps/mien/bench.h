// `mien bench`: time of each network on one core.
#pragma once

#include <string>

namespace mien::app {

struct BenchOptions {
  std::string model;  // empty: all
  std::string tier;   // empty: all this CPU has
  std::string models;
  bool json = false;
};

// Throws Failure.
void bench(const BenchOptions& options);

}  // namespace mien::app
