// Lists the cameras and microphones of this machine.
#include "apps/mien/sources/devices.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {
namespace {

using enum CaptureKind;

[[maybe_unused]] std::string contents(const char* path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// ffmpeg's messages. Listing devices ends with an error status, which is expected.
[[maybe_unused]] std::string ffmpeg_messages(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {"ffmpeg", "-hide_banner", "-nostdin"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Subprocess ffmpeg(command, Subprocess::Pipe::kFromChild);
  std::string text = ffmpeg.read_all();
  ffmpeg.finish();
  return text + ffmpeg.take_errors();
}

void append(std::vector<Device>& all, std::vector<Device> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

const char* kind_name(CaptureKind kind) { return kind == kCamera ? "camera" : "microphone"; }

}  // namespace

std::vector<Device> devices() {
  std::vector<Device> all;
#if defined(__APPLE__)
  append(all, parse_avfoundation(
                  ffmpeg_messages({"-f", "avfoundation", "-list_devices", "true", "-i", ""})));
#elif defined(_WIN32)
  append(all,
         parse_dshow(ffmpeg_messages({"-f", "dshow", "-list_devices", "true", "-i", "dummy"})));
#else
  append(all, video4linux("/sys/class/video4linux"));
  append(all, parse_pulse(ffmpeg_messages({"-sources", "pulse"})));
  append(all, parse_alsa(contents("/proc/asound/pcm")));
#endif
  return all;
}

void print_devices(bool json) {
  const std::vector<Device> all = devices();
  bool wanted = true;
  if (json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Device& device : all) {
      list.push_back({{"kind", kind_name(device.kind)},
                      {"name", device.name},
                      {"description", device.description}});
    }
    write_standard_output(json_text(list) + "\n", wanted);
  } else {
    for (const CaptureKind kind : {kCamera, kMicrophone}) {
      bool any = false;
      for (const Device& device : all) {
        if (device.kind == kind) {
          any = true;
          write_standard_output(
              std::string(kind_name(kind)) + "\t" + device.name + "\t" + device.description + "\n",
              wanted);
        }
      }
      if (!any) {
        std::fprintf(stderr, "no %s\n", kind_name(kind));
      }
    }
  }
  write_standard_output("", wanted);
}

}  // namespace mien::app
