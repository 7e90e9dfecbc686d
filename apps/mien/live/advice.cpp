// Advice for errors of input devices.
#include "apps/mien/live/advice.h"

#include <array>
#include <string_view>

namespace mien::app {
namespace {

struct Advice {
  std::string_view error;  // part of a message of the operating system or of ffmpeg
  std::string_view camera, microphone;
};

constexpr std::array<Advice, 4> kAdvice = {{
    {"No such file or directory", "connect a camera, or choose one that `mien devices` lists",
     "connect a microphone, or choose one that `mien devices` lists"},
    {"Permission denied", "allow the camera: on Linux, add the user to the group video",
     "allow the microphone: on Linux, add the user to the group audio"},
    {"Operation not permitted", "allow the camera in the system's privacy settings",
     "allow the microphone in the system's privacy settings"},
    {"Device or resource busy", "close the program that uses the camera",
     "close the program that uses the microphone"},
}};

}  // namespace

std::string advised(CaptureKind kind, const std::string& error) {
  if (error.find("cannot run 'ffmpeg'") != std::string::npos) {
    return error;  // cannot_run has advised
  }
  for (const Advice& advice : kAdvice) {
    if (error.find(advice.error) != std::string::npos) {
      const std::string_view text =
          kind == CaptureKind::kCamera ? advice.camera : advice.microphone;
      return std::string(error).append("; ").append(text);
    }
  }
  return error;
}

}  // namespace mien::app
