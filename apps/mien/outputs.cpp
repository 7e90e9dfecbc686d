#include "apps/mien/outputs.h"

#include <cstdio>
#include <string>

#include "apps/mien/failure.h"

namespace mien::app {

Outputs::Outputs(const TrackOptions& options, const VideoInfo& info, const VideoRange& range)
    : faces_(options.max_faces > 1 ? Faces::kSeveral : Faces::kOne) {
  if (!options.curves.empty()) {
    curves_ = std::make_unique<OutputFile>(options.curves);
    curves_->write(curve_header(faces_));
  } else {
    std::fputs(curve_header(faces_).c_str(), stdout);
  }
  if (!options.landmarks.empty()) {
    landmarks_ = std::make_unique<OutputFile>(options.landmarks);
    landmarks_->write(landmark_header(faces_));
  }
  if (!options.overlay.empty()) {
    overlay_ = std::make_unique<Overlay>(info.width, info.height);
    const std::string sound_from = options.input == "-" ? "" : options.input;
    encoder_ = std::make_unique<VideoEncoder>(options.overlay, overlay_->width(),
                                              overlay_->height(), info.fps, sound_from, range);
  }
}

void Outputs::frame(std::int64_t number, const mien_image* image, std::span<const Result> faces) {
  for (const Result& face : faces) {
    rows(number, face);
  }
  if (overlay_ && image != nullptr) {
    encoder_->write(overlay_->draw(*image, faces).rgb());
  }
}

void Outputs::rows(std::int64_t number, const Result& face) {
  const std::string row = curve_row(number, faces_, face);
  if (curves_) {
    curves_->write(row);
  } else {
    std::fputs(row.c_str(), stdout);
  }
  if (landmarks_) {
    landmarks_->write(landmark_row(number, faces_, face));
  }
}

void Outputs::finish() {
  if (encoder_) {
    encoder_->finish();
  }
  if (landmarks_) {
    landmarks_->finish();
  }
  if (curves_) {
    curves_->finish();
  } else if (std::fflush(stdout) != 0) {
    throw Failure(kExitOutput, "standard output: cannot be written");
  }
}

}  // namespace mien::app
