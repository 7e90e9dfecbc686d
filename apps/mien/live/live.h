// `mien live`: a camera and a microphone go in, other programs get the face as it moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mien::app {

struct LiveOptions {
  std::string camera;                     // empty: the first of this machine
  std::optional<std::string> microphone;  // none: what belongs to the camera
  std::vector<std::string> destinations;  // empty: nothing is sent
  std::string neutral;                    // file to take into account
  std::string stats;                      // file; empty: none
  std::string models, tier;
  std::optional<int> lod;  // 0: automatic; none: the highest that there are weights for
  float budget_ms = 10.0f;
  double av_offset_ms = 0.0;
  float voice_strength = 1.0f;
  float fov_degrees = 60.0f;
  std::optional<double> duration_s;
  bool unfiltered = false;
  bool mirror = false;
  bool quiet = false;
};

// Until it is told to end, or a file has ended. Throws Failure.
void live(const LiveOptions& options);

}  // namespace mien::app
