// Maps names of cameras and microphones to arguments of ffmpeg.
#pragma once

#include <string>
#include <vector>

namespace mien::app {

enum class CaptureKind { kCamera, kMicrophone };

// The default of --camera and --mic: the first device of this machine.
[[nodiscard]] std::string default_device(CaptureKind kind);

// ffmpeg's arguments for a device or a URL. A device is a name in this system's default interface
// (a number or path of Video4Linux, a source of PulseAudio), or "INTERFACE:NAME" for another
// interface: "alsa:hw:1". Throws Failure(kExitUsage).
[[nodiscard]] std::vector<std::string> capture_arguments(CaptureKind kind,
                                                         const std::string& device);

}  // namespace mien::app
