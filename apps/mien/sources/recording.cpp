// Describes the streams of an input with ffprobe.
#include "apps/mien/sources/recording.h"

#include <mien/mien.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {
namespace {

using nlohmann::json;

constexpr double kMinPixelAspect = 0.1, kMaxPixelAspect = 10.0;

// Excludes titles and other text of the input.
constexpr const char* kEntries =
    "stream=index,codec_type,codec_name,width,height,sample_aspect_ratio,time_base,avg_frame_rate,"
    "nb_frames,duration,sample_rate:stream_disposition=attached_pic:stream_side_data=rotation:"
    "format=duration";

// ffprobe writes some numbers as strings, and "N/A" for unknown values.
double number(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) {
    return 0.0;
  }
  return found->is_string() ? std::atof(found->get_ref<const std::string&>().c_str())
                            : (found->is_number() ? found->get<double>() : 0.0);
}

std::string text(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Parses "30000/1001" or "4:3". Returns 0 for an unknown ratio.
double ratio(const std::string& written) {
  const std::size_t sign = written.find_first_of("/:");
  const double numerator = std::atof(written.c_str());
  const double denominator =
      sign == std::string::npos ? 1.0 : std::atof(written.c_str() + sign + 1);
  return denominator > 0.0 ? numerator / denominator : 0.0;
}

int whole(double value) {
  return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(INT32_MAX)));
}

int rotation_of(const json& stream) {
  double degrees = 0.0;  // counterclockwise
  for (const json& side_data : stream.value("side_data_list", json::array())) {
    degrees = side_data.contains("rotation") ? number(side_data, "rotation") : degrees;
  }
  const int clockwise = static_cast<int>(std::lround(std::fmod(360.0 - degrees, 360.0)));
  return clockwise % 360;
}

// Pixels are assumed to be square if the aspect ratio is missing or invalid.
double pixel_aspect_of(const json& stream) {
  const double declared = ratio(text(stream, "sample_aspect_ratio"));
  return declared >= kMinPixelAspect && declared <= kMaxPixelAspect ? declared : 1.0;
}

VideoTrack video_track(const json& stream, const json& format) {
  VideoTrack track;
  track.index = whole(number(stream, "index"));
  track.codec = text(stream, "codec_name");
  track.width = whole(number(stream, "width"));
  track.height = whole(number(stream, "height"));
  track.pixel_aspect = pixel_aspect_of(stream);
  track.rotation = rotation_of(stream);
  track.time_base = text(stream, "time_base");
  const double fps = ratio(text(stream, "avg_frame_rate"));
  track.fps = fps > 0.0 ? fps : track.fps;
  const double counted = number(stream, "nb_frames");
  const double own_s = number(stream, "duration");
  const double frames =
      counted > 0.0 ? counted : fps * (own_s > 0.0 ? own_s : number(format, "duration"));
  if (frames >= 1.0 && frames < 1e15) {
    track.frames = static_cast<std::int64_t>(frames);
  }
  return track;
}

json run_ffprobe(const std::string& input, std::string& error) {
  std::vector<std::string> command = {
      "ffprobe",       "-v",     "error", "-max_pixels", std::to_string(kMaxPixels),
      "-show_entries", kEntries, "-of",   "json"};
  const std::vector<std::string> source = input_arguments(input);
  command.insert(command.end(), source.begin(), source.end());
  Subprocess ffprobe(command, Subprocess::Pipe::kFromChild, timeout_of(input));
  const std::string answer = ffprobe.read_all();
  const int status = ffprobe.finish();
  error = last_line(ffprobe.take_errors());
  json found = json::parse(answer, nullptr, false);
  if (status == 0 && found.is_object()) {
    return found;
  }
  if (is_url(input)) {
    throw Failure(kExitNoInput, input + ": cannot be opened: " + error);
  }
  throw Failure(kExitNoVideo, input + ": neither video nor audio that ffmpeg can read: " + error);
}

void require_file(const std::string& input) {
  if (is_url(input)) {
    return;
  }
  std::error_code ignored;
  if (!std::filesystem::exists(path_of(input), ignored)) {
    throw Failure(kExitNoInput, input + ": no such file");
  }
  if (std::filesystem::is_directory(path_of(input), ignored)) {
    throw Failure(kExitNoInput, input + ": is a directory");
  }
}

void check_size(const VideoTrack& track, const std::string& input, const std::string& error) {
  if (track.width <= 0 || track.height <= 0) {
    throw Failure(kExitNoVideo,
                  input + ": unknown image size" + (error.empty() ? "" : ": " + error));
  }
  const DisplaySize size = display_size(track, {});
  const std::int64_t pixels =
      std::max(std::int64_t{track.width} * track.height, std::int64_t{size.width} * size.height);
  if (pixels > kMaxPixels ||
      std::max({size.width, size.height, track.width, track.height}) > MIEN_MAX_IMAGE_SIDE) {
    throw Failure(kExitNoVideo, input + ": image too large (got " + std::to_string(track.width) +
                                    "x" + std::to_string(track.height) + ", expected at most " +
                                    std::to_string(kMaxPixels) + " pixels and " +
                                    std::to_string(MIEN_MAX_IMAGE_SIDE) + " per side)");
  }
}

}  // namespace

DisplaySize display_size(const VideoTrack& track, std::optional<int> rotation) {
  const int turn = rotation.value_or(track.rotation) % 180;
  const bool sideways = std::abs(turn - 90) <= 1;
  const int width = sideways ? track.height : track.width;
  const double aspect = sideways ? 1.0 / track.pixel_aspect : track.pixel_aspect;
  return {std::max(1, static_cast<int>(std::lround(width * aspect))),
          sideways ? track.width : track.height};
}

Recording probe_recording(const std::string& input) {
  require_file(input);
  std::string error;
  const json found = run_ffprobe(input, error);
  const json format = found.value("format", json::object());
  Recording recording;
  for (const json& stream : found.value("streams", json::array())) {
    const std::string kind = text(stream, "codec_type");
    const json disposition = stream.value("disposition", json::object());
    if (kind == "video" && !recording.video && number(disposition, "attached_pic") == 0.0) {
      recording.video = video_track(stream, format);
      check_size(*recording.video, input, error);
    } else if (kind == "audio" && number(stream, "sample_rate") > 0.0) {
      recording.audio.push_back({whole(number(stream, "index")), text(stream, "codec_name")});
    }
  }
  if (!recording.video && recording.audio.empty()) {
    throw Failure(kExitNoVideo, input + ": neither video nor audio");
  }
  return recording;
}

void require_video(const std::string& input) {
  if (!probe_recording(input).video) {
    throw Failure(kExitNoVideo, input + ": no video stream");
  }
}

}  // namespace mien::app
