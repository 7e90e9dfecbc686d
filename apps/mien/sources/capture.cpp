#include "apps/mien/sources/capture.h"

#include <algorithm>
#include <string_view>

#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

// One of ffmpeg's input devices.
struct Interface {
  CaptureKind kind;
  std::string_view name;
  std::string_view before, after;      // around a device's name
  std::string_view number_before;      // where the name is a number
  std::vector<std::string> arguments;  // so that it does not hold back what it has
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

// The interface of this system that needs no name.
std::string_view own_interface(CaptureKind kind) {
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
    // What arrives while the stream is probed is a burst of old pictures, of which the newest wins;
    // "-fflags nobuffer" would throw it away up to the next whole picture.
    std::vector<std::string> arguments = {"-flags", "low_delay"};
    const std::vector<std::string> input = input_arguments(device);
    arguments.insert(arguments.end(), input.begin(), input.end());
    return arguments;
  }
  if (device.empty()) {
    throw Failure(kExitUsage, kind == CaptureKind::kCamera ? "--camera: names no camera"
                                                           : "--mic: names no microphone");
  }
  std::string_view name = device;
  const std::size_t colon = name.find(':');
  const Interface* by = nullptr;
  if (colon != std::string_view::npos) {
    by = interface_named(kind, name.substr(0, colon));
  }
  if (by != nullptr) {
    name.remove_prefix(colon + 1);
  } else {
    by = interface_named(kind, own_interface(kind));
  }
  std::vector<std::string> arguments = {"-f", std::string(by->name)};
  arguments.insert(arguments.end(), by->arguments.begin(), by->arguments.end());
  const std::string_view before = is_number(name) ? by->number_before : by->before;
  arguments.insert(arguments.end(), {"-i", std::string(before).append(name).append(by->after)});
  return arguments;
}

}  // namespace mien::app
