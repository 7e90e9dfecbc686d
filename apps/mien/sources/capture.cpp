// Maps device names to arguments of ffmpeg's input devices.
#include "apps/mien/sources/capture.h"

#include <algorithm>
#include <string_view>

#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

// An input device of ffmpeg.
struct Interface {
  CaptureKind kind;
  std::string_view name;
  std::string_view before, after;      // text around a device's name
  std::string_view number_before;      // text before a device's number
  std::vector<std::string> arguments;  // options that disable its buffering
};

const std::vector<Interface>& interfaces() {
  using enum CaptureKind;
  static const std::vector<Interface> all = {
      {kCamera, "v4l2", "", "", "/dev/video", {}},
      {kCamera, "avfoundation", "", ":none", "", {"-framerate", "30"}},
      {kCamera, "dshow", "video=", "", "video=", {"-rtbufsize", "64M"}},
      {kCamera, "lavfi", "", "", "", {"-re"}},
      {kMicrophone,
       "pulse",
       "",
       "",
       "",
       {"-sample_rate", "16000", "-channels", "1", "-fragment_size", "640"}},
      {kMicrophone, "alsa", "", "", "hw:", {}},
      {kMicrophone, "avfoundation", "none:", "", "none:", {}},
      {kMicrophone, "dshow", "audio=", "", "audio=", {"-audio_buffer_size", "20"}},
      {kMicrophone, "lavfi", "", "", "", {"-re"}},
  };
  return all;
}

// The default interface of this system.
std::string_view default_interface(CaptureKind kind) {
#if defined(__APPLE__)
  static_cast<void>(kind);
  return "avfoundation";
#elif defined(_WIN32)
  static_cast<void>(kind);
  return "dshow";
#else
  return kind == CaptureKind::kCamera ? "v4l2" : "pulse";
#endif
}

const Interface* interface_named(CaptureKind kind, std::string_view name) {
  const auto found = std::find_if(
      interfaces().begin(), interfaces().end(),
      [&](const Interface& candidate) { return candidate.kind == kind && candidate.name == name; });
  return found == interfaces().end() ? nullptr : &*found;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

std::string default_device(CaptureKind kind) {
#if defined(__linux__)
  return kind == CaptureKind::kCamera ? "/dev/video0" : "default";
#else
  static_cast<void>(kind);
  return "0";
#endif
}

std::vector<std::string> capture_arguments(CaptureKind kind, const std::string& device) {
  if (is_url(device)) {
    // While ffmpeg probes a stream, a burst of old images arrives; the newest of them is used.
    // `-fflags nobuffer` would discard images until the next keyframe.
    std::vector<std::string> arguments = {"-flags", "low_delay"};
    const std::vector<std::string> input = input_arguments(device);
    arguments.insert(arguments.end(), input.begin(), input.end());
    return arguments;
  }
  if (device.empty()) {
    throw Failure(kExitUsage, kind == CaptureKind::kCamera
                                  ? "--camera: expected a device (got an empty name)"
                                  : "--mic: expected a device (got an empty name)");
  }
  std::string_view name = device;
  const std::size_t colon = name.find(':');
  const Interface* selected = nullptr;
  if (colon != std::string_view::npos) {
    selected = interface_named(kind, name.substr(0, colon));
  }
  if (selected != nullptr) {
    name.remove_prefix(colon + 1);
  } else {
    selected = interface_named(kind, default_interface(kind));
  }
  std::vector<std::string> arguments = {"-f", std::string(selected->name)};
  arguments.insert(arguments.end(), selected->arguments.begin(), selected->arguments.end());
  const std::string_view before = is_number(name) ? selected->number_before : selected->before;
  arguments.insert(arguments.end(),
                   {"-i", std::string(before).append(name).append(selected->after)});
  return arguments;
}

}  // namespace mien::app
