// What `mien live` shows of itself, as lines of text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/mien/live/statistics.h"
#include "formats/animation/clip.h"

namespace mien::app {

struct ScreenState {
  std::string camera, microphone;      // what they are, or why there is nothing of them
  std::vector<std::string> receivers;  // a line each
  formats::Frame frame;                // as it is sent
  int level = 0;                       // that runs
  bool automatic = false, mirrored = false, calibrating = false;
  std::uint64_t dropped_images = 0;  // since the beginning
  std::uint64_t dropped_packets = 0;
};

// Lines of 80 columns at most, each with its line feed.
[[nodiscard]] std::string screen_text(const ScreenState& state, const LiveStatistics& statistics);

}  // namespace mien::app
