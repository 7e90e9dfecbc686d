// `mien track --report`: one page with the clip, the face, the curves and all exports.
#pragma once

#include <cstdint>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/report/columns.h"
#include "apps/mien/report/waveform.h"
#include "apps/mien/tracking/stage_times.h"
#include "formats/animation/animation.h"

namespace mien::app {

struct ReportOptions {
  std::string page;                  // file
  std::string picture, sound;        // files that the clip is made of; empty: none
  int audio_track = 1;               // of `sound`; the first is 1
  std::optional<int> rotation;       // degrees clockwise, instead of what `picture` says
  double largest_clip_bytes = 64e6;  // a larger one lies beside the page
  std::string name;                  // of what was tracked
  int width = 0, height = 0;         // of the picture, pixels
  formats::WriteOptions writing;
};

// The file beside a page that holds the clip if that is too large for the page.
std::string clip_beside(const std::string& page);

class Report {
 public:
  explicit Report(const ReportOptions& options);  // throws Failure(kExitOutput), as the others

  void frame(const formats::Frame& frame, const Result& result);
  void hear(const Audio& block, std::int64_t pts_ns) { waveform_.hear(block, pts_ns); }

  // Makes the clip, too: throws what `web_video` throws.
  void finish(const StageTimes& times);

 private:
  struct Clip {
    std::string bytes;   // MP4 that goes into the page
    std::string beside;  // name of the file in the page's folder that it went to instead
  };

  [[nodiscard]] double start_ms() const;
  [[nodiscard]] double end_ms() const;
  [[nodiscard]] Columns columns() const;
  [[nodiscard]] std::string packed_landmarks() const;
  Clip clip();
  [[nodiscard]] nlohmann::ordered_json facts(const StageTimes& times, const Clip& clip) const;

  ReportOptions options_;
  OutputFile file_;  // before the work that would be lost on a page that cannot be
  std::optional<PartialFile> clip_file_;  // so, too; none: there is no clip
  std::vector<formats::Frame> frames_;
  std::vector<double> took_ms_;          // each frame
  std::vector<std::int16_t> landmarks_;  // [frames][MIEN_LANDMARK_COUNT * 2], in `landmark_unit`s
  double landmark_unit_ = 1.0;           // pixels
  Waveform waveform_;
};

}  // namespace mien::app
