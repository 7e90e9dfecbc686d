// `mien track`: video and sound go in, curves come out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mien::app {

// What of picture and sound is taken: kAny what there is, the others just that.
enum class Mode { kAny, kBoth, kVideo, kAudio };

struct TrackOptions {
  std::string input;
  std::string curves;     // empty: standard output
  std::string landmarks;  // empty: none; so for the others
  std::string overlay;
  std::string audio;  // file with the sound; empty: the input
  Mode mode = Mode::kAny;
  double av_offset_ms = 0.0;  // that the sound is late by
  std::string stats;
  std::string neutral;  // file to take into account
  std::string tier;
  bool unfused = false;  // networks run layer by layer
  std::string models;
  std::optional<int> lod;  // 0: automatic; none: the highest that there are weights for
  float budget_ms = 10.0f;
  bool unfiltered = false;
  int max_faces = 1;
  double start_s = 0.0;
  std::optional<double> duration_s;
  bool quiet = false;
};

// Throws Failure.
void track(const TrackOptions& options);

}  // namespace mien::app
