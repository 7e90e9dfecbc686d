// Lists of cameras and microphones as systems and ffmpeg have them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/mien/sources/capture.h"

namespace mien::app {

struct Device {
  CaptureKind kind;
  std::string name;         // for --camera or --mic
  std::string description;  // for people
};

// What ffmpeg says of the interfaces of other systems: "-list_devices true" of avfoundation and
// dshow, and "-sources pulse".
std::vector<Device> parse_avfoundation(std::string_view text);
std::vector<Device> parse_dshow(std::string_view text);
std::vector<Device> parse_pulse(std::string_view text);

// Of Video4Linux, by `folder`: /sys/class/video4linux. Those of a camera that give no pictures but
// data about them are left out.
std::vector<Device> video4linux(const std::string& folder);
// Of ALSA, by its list: /proc/asound/pcm.
std::vector<Device> parse_alsa(std::string_view text);

}  // namespace mien::app
