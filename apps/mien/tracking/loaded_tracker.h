// A tracker with the weights it runs on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mien/mien.hpp>
#include <optional>
#include <string>

#include "apps/mien/networks/model_files.h"

namespace mien::app {

struct LoadedTracker {
  struct Options {
    std::string models;          // folder; empty: see models_directory
    std::string tier;            // empty: the best of this CPU
    std::optional<int> lod = 1;  // 0: automatic; none: the highest that there are weights for
    float budget_ms = 10.0f;
    bool unfiltered = false;
    int max_faces = 1;
    bool sound = false;    // it is to hear
    bool unfused = false;  // networks run layer by layer
    float voice_strength = 1.0f;
    float fov_degrees = 60.0f;
    std::int32_t queued_samples = 0;  // room for sound that another thread brings
  };

  // Throws Failure.
  explicit LoadedTracker(const Options& options);

  Blob basenet, proposal;
  std::optional<Blob> hifinet;   // where there is one
  std::optional<Blob> audionet;  // if it is to hear
  Tracker tracker;
  std::size_t tracker_bytes = 0;  // memory of the tracker, the weights not counted
};

// Throws a Failure that names `where` unless all is well.
void check(mien_status status, const std::string& where);

// Whether the folder of the models has one for sound.
bool has_audionet(const std::string& models);

// Takes over a file of `mien neutral`. Throws Failure.
void load_neutral(const std::string& path, Tracker& tracker);

}  // namespace mien::app
