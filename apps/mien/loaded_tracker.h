// A tracker with the weights it runs on.
#pragma once

#include <cstddef>
#include <mien/mien.hpp>
#include <optional>
#include <string>

#include "apps/mien/model_files.h"

namespace mien::app {

struct LoadedTracker {
  struct Options {
    std::string models;  // folder; empty: see models_directory
    std::string tier;    // empty: the best of this CPU
    int lod = 1;         // 0: automatic
    float budget_ms = 10.0f;
    bool unfiltered = false;
  };

  // Throws Failure.
  explicit LoadedTracker(const Options& options);

  Blob basenet, proposal;
  std::optional<Blob> hifinet;  // where there is one
  Tracker tracker;
  std::size_t tracker_bytes = 0;  // memory of the tracker, the weights not counted
};

}  // namespace mien::app
