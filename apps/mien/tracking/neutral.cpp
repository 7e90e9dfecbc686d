#include "apps/mien/tracking/neutral.h"

#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

using NeutralBytes = std::array<std::byte, MIEN_NEUTRAL_BYTES>;

// Plays the video until the tracker has captured what bit `wanted` stands for.
NeutralBytes capture(const NeutralOptions& options, Tracker& tracker, std::uint32_t wanted) {
  check(tracker.capture_neutral(), options.input);
  const std::unique_ptr<VideoSource> video =
      open_video(options.input, {options.start_s, options.duration_s});
  NeutralBytes file = {};
  std::uint32_t captured = 0;
  mien_image image;
  std::int64_t pts_ns = 0;
  while ((captured & wanted) == 0 && video->next(image, pts_ns)) {
    check(tracker.push_video(image, pts_ns), options.input);
    check(tracker.save_neutral(file, captured), options.input);
  }
  if ((captured & wanted) == 0) {
    throw Failure(kExitNoFace, options.input + ": no 55 frames in a row show a face");
  }
  return file;
}

}  // namespace

void neutral(const NeutralOptions& options) {
  LoadedTracker loaded({options.models, ""});
  NeutralBytes file = capture(options, loaded.tracker, 1);
  if (loaded.hifinet) {
    check(loaded.tracker.set_lod(4), options.input);
    file = capture(options, loaded.tracker, 2);
  }
  OutputFile output(options.output);
  output.write({reinterpret_cast<const char*>(file.data()), file.size()});
  output.finish();
  if (options.json) {
    const nlohmann::ordered_json done = {
        {"input", options.input},
        {"output", options.output},
        {"levels", loaded.hifinet ? std::vector<int>{1, 2, 3, 4} : std::vector<int>{1}}};
    std::printf("%s\n", done.dump(1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else if (!options.quiet) {
    std::fprintf(stderr, "%s: for %s\n", options.output.c_str(),
                 loaded.hifinet ? "all levels of detail" : "level of detail 1");
  }
}

}  // namespace mien::app
