// What `mien track` writes for every frame.
#pragma once

#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <span>

#include "apps/mien/curves.h"
#include "apps/mien/ffmpeg.h"
#include "apps/mien/output_file.h"
#include "apps/mien/overlay.h"
#include "apps/mien/track.h"
#include "apps/mien/video_source.h"

namespace mien::app {

class Outputs {
 public:
  // `info` of the video that is drawn over; not asked for without an overlay.
  Outputs(const TrackOptions& options, const VideoInfo& info, const VideoRange& range);
  // `image` is nullptr where there is none.
  void frame(std::int64_t number, const mien_image* image, std::span<const Result> faces);
  void finish();

 private:
  void rows(std::int64_t number, const Result& face);

  Faces faces_;
  std::unique_ptr<OutputFile> curves_;
  std::unique_ptr<OutputFile> landmarks_;
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<VideoEncoder> encoder_;
};

}  // namespace mien::app
