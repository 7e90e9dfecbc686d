// The screen of `mien live` as text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/animation/clip.h"
#include "apps/mien/live/inputs.h"
#include "apps/mien/live/sender_set.h"
#include "apps/mien/live/statistics.h"

namespace mien::app {

struct ScreenState {
  InputState camera, microphone;
  std::vector<ReceiverState> receivers;
  std::string page;        // URL; empty: none
  animation::Frame frame;  // as sent
  int level = 0;           // current level of detail
  bool automatic = false, mirrored = false, calibrating = false;
  std::uint64_t dropped_images = 0;  // since the start
  std::uint64_t dropped_packets = 0;
};

// Lines of at most 80 columns, each with a line feed.
[[nodiscard]] std::string screen_text(const ScreenState& state, const LiveStatistics& statistics);

}  // namespace mien::app
