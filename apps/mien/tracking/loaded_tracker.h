// A tracker with its weights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mien/mien.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/networks/model_files.h"

namespace mien::app {

struct LoadedTracker {
  struct Options {
    std::string models;          // folder; empty: see models_directory
    std::string tier;            // empty: the best of this CPU
    std::optional<int> lod = 1;  // 0: automatic; default: the highest with weights
    float budget_ms = 10.0f;
    bool unfiltered = false;
    int max_faces = 1;
    bool sound = false;    // accept audio
    bool unfused = false;  // run networks layer by layer
    float voice_strength = 1.0f;
    float fov_degrees = 60.0f;
    std::int32_t queued_samples = 0;  // size of the queue for audio from another thread
  };

  // Throws Failure.
  explicit LoadedTracker(const Options& options);

  OpenedWeights weights;
  bool has_hifinet = false;
  bool has_audio = false;  // the tracker accepts audio
  Tracker tracker;
  std::size_t tracker_bytes = 0;  // memory of the tracker without weights
};

// Throws a Failure that names `where` if `status` is an error.
void check(mien_status status, const std::string& where);

// The results of all faces; one result without a face while searching. Throws like `check`.
[[nodiscard]] std::vector<Result> results(const Tracker& tracker, const std::string& where);

// Whether the folder of models has audionet.mien.
bool has_audionet(const std::string& models);

// Loads a neutral file into the tracker. Throws Failure.
void load_neutral(const std::string& path, Tracker& tracker);

}  // namespace mien::app
