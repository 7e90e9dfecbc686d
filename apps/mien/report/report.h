// Implements `mien track --report`: a page with the clip, the animated face, curves and all
// exports.
#pragma once

#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/writer.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/report/columns.h"
#include "apps/mien/report/waveform.h"
#include "apps/mien/tracking/stage_times.h"

namespace mien::app {

struct ReportOptions {
  std::string page;              // file
  std::string video, audio;      // files for the clip; empty: none
  int audio_track = 1;           // of `audio`; the first is 1
  std::optional<int> rotation;   // degrees clockwise; overrides that of `video`
  double max_clip_bytes = 64e6;  // a larger clip is stored beside the page
  std::string name;              // of the input
  std::string avatar;            // of the user: file; empty: mien's
  int width = 0, height = 0;     // of the image, pixels
  animation::WriteOptions writing;
};

// The file for a clip that is too large for the page.
std::string clip_beside(const std::string& page);

class Report {
 public:
  explicit Report(
      const ReportOptions& options);  // throws Failure(kExitOutput), as the other functions

  void frame(const animation::Frame& frame, const Result& result);
  void push_audio(const Audio& block, std::int64_t pts_ns) { waveform_.push_audio(block, pts_ns); }

  // Also transcodes the clip; throws the exceptions of `web_video`. Call it once.
  void finish(const StageTimes& times);

 private:
  struct Clip {
    std::string bytes;   // MP4 for the page
    std::string beside;  // or its file name in the page's folder
  };

  [[nodiscard]] double start_ms() const;
  [[nodiscard]] double end_ms() const;
  [[nodiscard]] Columns columns() const;
  [[nodiscard]] std::string packed_landmarks() const;
  Clip clip();
  [[nodiscard]] nlohmann::ordered_json facts(const StageTimes& times, const Clip& clip) const;

  ReportOptions options_;
  OutputFile file_;  // opened first, so that an unwritable page fails before the work
  std::optional<PartialFile> clip_file_;             // likewise; empty: no clip
  std::unique_ptr<animation::AnimationWriter> glb_;  // likewise; nullptr: mien's avatar
  std::vector<animation::Frame> frames_;
  std::vector<double> took_ms_;  // per frame
  std::vector<std::int16_t>
      landmarks_;               // [frames][MIEN_LANDMARK_COUNT * 2], multiples of landmark_unit_
  double landmark_unit_ = 1.0;  // pixels
  Waveform waveform_;
};

}  // namespace mien::app
