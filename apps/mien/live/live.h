// Implements `mien live`: tracks a camera and a microphone, and sends the results to other
// programs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mien::app {

struct LiveOptions {
  std::string camera;                     // empty: the first of this machine
  std::optional<std::string> microphone;  // default: the microphone that belongs to the camera
  std::vector<std::string> destinations;  // empty: nothing is sent
  std::string neutral;                    // neutral file; empty: none
  std::string profile;                    // file; empty: none
  std::optional<std::uint16_t> page;      // port of the page, 0: a free one; default: no page
  std::string page_token;                 // file; empty: a new token for each run
  std::string stats;                      // path; empty: none
  std::string models, tier;
  std::optional<int> lod;  // 0: automatic; default: the highest level with weights
  float budget_ms = 10.0f;
  double av_offset_ms = 0.0;
  float voice_strength = 1.0f;
  float fov_degrees = 60.0f;
  std::optional<double> duration_s;
  bool unfiltered = false;
  bool mirror = false;
  bool quiet = false;
};

// Runs until interrupted or until a file ends. Throws Failure.
void live(const LiveOptions& options);

}  // namespace mien::app
