// Implements `mien run`, which runs a network of a weight file on arrays.
#pragma once

#include <string>
#include <vector>

namespace mien::app {

enum class MapLayout { kChannelsFirst, kChannelsLast };

struct RunOptions {
  std::string model;
  std::string network;  // empty: the only one
  std::string input;
  std::vector<std::string> outputs;
  MapLayout layout = MapLayout::kChannelsFirst;
  std::string tier;  // empty: the best
};

// Throws Failure.
void run_network(const RunOptions& options);

}  // namespace mien::app
