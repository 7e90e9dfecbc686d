// Captures neutral calibration from a video.
#include "apps/mien/tracking/neutral.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

using NeutralBytes = std::array<std::byte, MIEN_NEUTRAL_BYTES>;

std::unique_ptr<VideoSource> open(const NeutralOptions& options) {
  return open_video(options.input, {{options.start_s, options.duration_s}, {}, 1});
}

// A URL may lead to a file, which can be read again; then its number of frames is known.
bool can_be_shown_again(const std::string& input, const VideoSource& video) {
  if (is_url(input)) {
    return video.info().frames.has_value();
  }
  std::error_code unknown;
  return input != kStandardInput && std::filesystem::is_regular_file(path_of(input), unknown);
}

// Continues the video until the tracker has captured the calibration of bit `wanted`.
NeutralBytes capture(const NeutralOptions& options, VideoSource& video, Tracker& tracker,
                     std::uint32_t wanted) {
  check(tracker.capture_neutral(), options.input);
  NeutralBytes file = {};
  std::uint32_t captured = 0;
  mien_image image;
  std::int64_t pts_ns = 0;
  while ((captured & wanted) == 0 && video.next(image, pts_ns)) {
    check(tracker.push_video(image, pts_ns), options.input);
    check(tracker.save_neutral(file, captured), options.input);
  }
  if ((captured & wanted) == 0) {
    throw Failure(kExitNoFace, options.input + ": fewer than 55 frames in a row show a face");
  }
  return file;
}

}  // namespace

void neutral(const NeutralOptions& options) {
  LoadedTracker loaded({options.models, ""});
  std::vector<std::string> inputs = {options.input};
  for (const std::filesystem::path& weights : weight_files(models_directory(options.models))) {
    inputs.push_back(name_of(weights));
  }
  require_distinct_files(inputs, {options.output});
  std::unique_ptr<VideoSource> video = open(options);
  NeutralBytes file = capture(options, *video, loaded.tracker, 1);
  if (loaded.has_hifinet) {
    check(loaded.tracker.set_lod(4), options.input);
    if (can_be_shown_again(options.input, *video)) {
      video = open(options);
    }
    file = capture(options, *video, loaded.tracker, 2);
  }
  OutputFile output(options.output);
  output.write({reinterpret_cast<const char*>(file.data()), file.size()});
  output.finish();
  if (options.json) {
    const nlohmann::ordered_json done = {
        {"input", without_credentials(options.input)},
        {"output", options.output},
        {"levels", loaded.has_hifinet ? std::vector<int>{1, 2, 3, 4} : std::vector<int>{1}}};
    std::printf("%s\n", json_text(done).c_str());
  } else if (!options.quiet) {
    std::fprintf(stderr, "%s: neutral calibration for %s\n", printable(options.output).c_str(),
                 loaded.has_hifinet ? "all levels of detail" : "level of detail 1");
  }
}

}  // namespace mien::app
