// The outputs of `mien track`.
#pragma once

#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <span>
#include <vector>

#include "apps/mien/outputs/animation_output.h"
#include "apps/mien/outputs/landmarks.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/outputs/overlay.h"
#include "apps/mien/outputs/video_encoder.h"
#include "apps/mien/report/report.h"
#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/tracking/stage_times.h"
#include "apps/mien/tracking/track.h"

namespace mien::app {

class Outputs {
 public:
  // `info`: the size is 0 without video.
  Outputs(const TrackOptions& options, const VideoInfo& info, const VideoRange& range);
  // `image` is nullptr without video.
  void frame(std::int64_t number, const mien_image* image, std::span<const Result> faces);
  void finish(const StageTimes& times);

  // Receives the audio that the tracker receives; empty if no output needs it. Must not be used
  // after this object is destroyed.
  [[nodiscard]] AudioFeed::Listener listener();

  // False if the only output was standard output and its reader has closed it.
  [[nodiscard]] bool wanted() const;

 private:
  Faces faces_;
  std::vector<AnimationOutput> animations_;
  std::unique_ptr<OutputFile> landmarks_;
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<VideoEncoder> encoder_;
  std::unique_ptr<Report> report_;
  std::int64_t audio_offset_ns_;
};

}  // namespace mien::app
