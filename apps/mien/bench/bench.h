// Implements `mien bench`, which measures networks, tracking and audio processing on one core.
#pragma once

#include <string>

namespace mien::app {

struct BenchOptions {
  std::string model;  // empty: all
  std::string tier;   // empty: all tiers of this CPU
  std::string models;
  std::string clip;      // not empty: measure tracking of this video
  std::string levels;    // not empty: measure each level of detail on this video
  int rounds = 30;       // with `levels`: repetitions per frame; the fastest counts
  bool audio = false;    // measure audio processing
  bool unfused = false;  // run networks layer by layer
  bool layers = false;   // measure each layer or group of fused layers
  bool json = false;
};

// Throws Failure.
void bench(const BenchOptions& options);

}  // namespace mien::app
