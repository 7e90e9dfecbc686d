// `mien track`: a video goes in, curves come out.
#pragma once

#include <optional>
#include <string>

namespace mien::app {

struct TrackOptions {
  std::string input;
  std::string curves;     // empty: standard output
  std::string landmarks;  // empty: none; so for the others
  std::string overlay;
  std::string stats;
  std::string neutral;  // file to take into account
  std::string tier;
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
