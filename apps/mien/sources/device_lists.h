// Parses lists of cameras and microphones.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/mien/sources/capture.h"

namespace mien::app {

struct Device {
  CaptureKind kind;
  std::string name;         // for --camera or --mic
  std::string description;  // for display
};

// Parse ffmpeg's lists: "-list_devices true" of avfoundation and dshow, and "-sources pulse".
std::vector<Device> parse_avfoundation(std::string_view text);
std::vector<Device> parse_dshow(std::string_view text);
std::vector<Device> parse_pulse(std::string_view text);

// Lists Video4Linux cameras; `folder` is /sys/class/video4linux. Skips metadata devices.
std::vector<Device> video4linux(const std::string& folder);
// Parses ALSA's list, /proc/asound/pcm.
std::vector<Device> parse_alsa(std::string_view text);

}  // namespace mien::app
