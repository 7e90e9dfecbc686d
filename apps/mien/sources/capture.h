// Cameras and microphones by name, as ffmpeg is to open them.
#pragma once

#include <string>
#include <vector>

namespace mien::app {

enum class CaptureKind { kCamera, kMicrophone };

// What --camera and --mic name when nobody does: the first of this machine.
[[nodiscard]] std::string default_device(CaptureKind kind);

// ffmpeg's arguments for a device or a URL. A device is a name of this system's own interface (a
// number or a path of Video4Linux, a source of PulseAudio), or one of another interface behind its
// name and a colon: "alsa:hw:1". Throws Failure(kExitUsage).
[[nodiscard]] std::vector<std::string> capture_arguments(CaptureKind kind,
                                                         const std::string& device);

}  // namespace mien::app
