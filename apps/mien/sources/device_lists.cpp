// Parses device lists of operating systems and ffmpeg.
#include "apps/mien/sources/device_lists.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "apps/animation/numbers.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;
using enum CaptureKind;

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class Take>
void each_line(std::string_view text, Take take) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    take(animation::trimmed(line));
  }
}

// The message after ffmpeg's prefix "[AVFoundation indev @ 0x7f8] ".
std::string_view message_of(std::string_view line) {
  const std::size_t end = line.find("] ");
  return line.starts_with('[') && end != std::string_view::npos ? line.substr(end + 2) : line;
}

}  // namespace

std::vector<Device> video4linux(const std::string& folder) {
  std::vector<Device> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string node = entry.path().filename().string();
    if (node.starts_with("video") && animation::trimmed(contents(entry.path() / "index")) == "0") {
      found.push_back({kCamera, "/dev/" + node,
                       std::string(animation::trimmed(contents(entry.path() / "name")))});
    }
  }
  std::sort(found.begin(), found.end(), [](const Device& a, const Device& b) {
    return a.name.size() != b.name.size() ? a.name.size() < b.name.size() : a.name < b.name;
  });
  return found;
}

// Lines such as "01-00: USB Audio : USB Audio : playback 1 : capture 1".
std::vector<Device> parse_alsa(std::string_view text) {
  std::vector<Device> found;
  each_line(text, [&](std::string_view line) {
    std::int64_t card = 0, device = 0;
    if (line.find(": capture") == std::string_view::npos || line.size() < 6 || line[2] != '-' ||
        !animation::parse_number(line.substr(0, 2), card) ||
        !animation::parse_number(line.substr(3, 2), device)) {
      return;
    }
    std::string_view name = line.substr(std::min(line.size(), std::size_t{6}));
    name = animation::trimmed(name.substr(0, name.find(" : ")));
    found.push_back({kMicrophone, "alsa:hw:" + std::to_string(card) + "," + std::to_string(device),
                     std::string(name)});
  });
  return found;
}

// Lines such as "* alsa_input.usb [Microphone] (audio)". Monitors of outputs are skipped.
std::vector<Device> parse_pulse(std::string_view text) {
  std::vector<Device> found;
  each_line(text, [&](std::string_view line) {
    const std::size_t open = line.find(" [");
    const std::size_t close = line.rfind(']');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
      return;
    }
    std::string_view name = line.substr(0, open);
    name.remove_prefix(name.starts_with("* ") ? 2 : 0);
    if (!name.ends_with(".monitor")) {
      found.push_back({kMicrophone, std::string(animation::trimmed(name)),
                       std::string(line.substr(open + 2, close - open - 2))});
    }
  });
  return found;
}

// "AVFoundation video devices:", then lines such as "[0] FaceTime HD Camera".
std::vector<Device> parse_avfoundation(std::string_view text) {
  std::vector<Device> found;
  std::optional<CaptureKind> kind;
  each_line(text, [&](std::string_view line) {
    line = message_of(line);
    if (line.ends_with("devices:")) {
      kind = line.find("video") != std::string_view::npos ? kCamera : kMicrophone;
      return;
    }
    const std::size_t close = line.find("] ");
    if (kind && line.starts_with('[') && close != std::string_view::npos) {
      found.push_back(
          {*kind, std::string(line.substr(1, close - 1)), std::string(line.substr(close + 2))});
    }
  });
  return found;
}

// Lines such as "\"Integrated Camera\" (video)"; older ffmpeg prints them below "DirectShow audio
// devices".
std::vector<Device> parse_dshow(std::string_view text) {
  std::vector<Device> found;
  std::optional<CaptureKind> section;
  each_line(text, [&](std::string_view line) {
    line = animation::trimmed(message_of(line));
    if (line.starts_with("DirectShow")) {
      section = line.find("video") != std::string_view::npos ? kCamera : kMicrophone;
    }
    const std::size_t end = line.rfind('"');
    if (!line.starts_with('"') || end == 0) {
      return;
    }
    const std::string_view kind = line.substr(end + 1);
    const std::string name(line.substr(1, end - 1));
    if (kind.find("(video)") != std::string_view::npos || (kind.empty() && section == kCamera)) {
      found.push_back({kCamera, name, name});
    } else if (kind.find("(audio)") != std::string_view::npos ||
               (kind.empty() && section == kMicrophone)) {
      found.push_back({kMicrophone, name, name});
    }
  });
  return found;
}

}  // namespace mien::app
