// `mien bench`: time of each network, of the tracker on a clip, or of sound, on one core.
#pragma once

#include <string>

namespace mien::app {

struct BenchOptions {
  std::string model;  // empty: all
  std::string tier;   // empty: all this CPU has
  std::string models;
  std::string clip;      // not empty: the tracker on it
  std::string levels;    // not empty: a clip, a frame of which is timed at each level
  int rounds = 30;       // of that clip: of each frame the fastest time counts
  bool sound = false;    // time hearing
  bool unfused = false;  // layer by layer
  bool layers = false;   // each step of a network too
  bool json = false;
};

// Throws Failure.
void bench(const BenchOptions& options);

}  // namespace mien::app
