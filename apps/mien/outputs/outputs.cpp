// Distributes the results of a frame to all outputs.
#include "apps/mien/outputs/outputs.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "apps/mien/outputs/result_frame.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"

namespace mien::app {
namespace {

// With a report, an animation on standard output must be requested explicitly.
bool wants_animation(const TrackOptions& options) {
  return options.report.empty() || !options.animation.files.empty() ||
         !options.animation.formats.empty();
}

// A report cannot show input that can be read only once.
std::string file_or_none(const std::string& input) { return input == kStandardOutput ? "" : input; }

ReportOptions report_options(const TrackOptions& options, const VideoInfo& info) {
  return {.page = options.report,
          .video = info.width > 0 ? file_or_none(options.input) : "",
          .audio = file_or_none(options.audio.empty() ? options.input : options.audio),
          .audio_track = options.audio_track,
          .rotation = options.rotation,
          .max_clip_bytes = options.report_clip_mb * 1e6,
          .name = name_of(path_of(without_credentials(options.input)).filename()),
          .avatar = options.animation.avatar,
          .width = info.width,
          .height = info.height,
          .writing = options.animation.writing};
}

}  // namespace

Outputs::Outputs(const TrackOptions& options, const VideoInfo& info, const VideoRange& range)
    : faces_(options.max_faces > 1 ? Faces::kSeveral : Faces::kOne),
      audio_offset_ns_(std::llround(options.av_offset_ms * 1e6)) {
  if (wants_animation(options)) {
    for (const AnimationTarget& target : targets(options.animation)) {
      animations_.emplace_back(target, options.animation.writing);
    }
  }
  if (!options.landmarks.empty()) {
    landmarks_ = std::make_unique<OutputFile>(options.landmarks);
    landmarks_->write(landmark_header(faces_));
  }
  if (!options.overlay.empty()) {
    overlay_ = std::make_unique<Overlay>(info.width, info.height);
    const std::string audio_from = options.input == "-" ? "" : options.input;
    encoder_ =
        std::make_unique<VideoEncoder>(options.overlay, overlay_->width(), overlay_->height(),
                                       info.fps, audio_from, options.audio_track, range);
  }
  if (!options.report.empty()) {
    report_ = std::make_unique<Report>(report_options(options, info));
  }
}

void Outputs::frame(std::int64_t number, const mien_image* image, std::span<const Result> faces) {
  for (const Result& face : faces) {
    const animation::Frame frame = frame_of(number, face);
    for (AnimationOutput& animation : animations_) {
      animation.frame(frame);
    }
    if (landmarks_) {
      landmarks_->write(landmark_row(number, faces_, face));
    }
    if (report_) {
      report_->frame(frame, face);
    }
  }
  if (overlay_ && image != nullptr) {
    encoder_->write(overlay_->draw(*image, faces).rgb(), faces.front().pts_ns);
  }
}

AudioFeed::Listener Outputs::listener() {
  if (!report_) {
    return {};
  }
  return [this](const Audio& block, std::int64_t pts_ns) {
    report_->push_audio(block, pts_ns + audio_offset_ns_);
  };
}

void Outputs::finish(const StageTimes& times) {
  if (encoder_) {
    encoder_->finish();
  }
  if (landmarks_) {
    landmarks_->finish();
  }
  for (AnimationOutput& animation : animations_) {
    animation.finish();
  }
  if (report_) {
    report_->finish(times);
  }
}

bool Outputs::wanted() const {
  return landmarks_ || encoder_ || report_ ||
         std::any_of(animations_.begin(), animations_.end(),
                     [](const AnimationOutput& animation) { return animation.wanted(); });
}

}  // namespace mien::app
