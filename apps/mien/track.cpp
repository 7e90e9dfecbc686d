#include "apps/mien/track.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "apps/mien/curves.h"
#include "apps/mien/failure.h"
#include "apps/mien/ffmpeg.h"
#include "apps/mien/loaded_tracker.h"
#include "apps/mien/output_file.h"
#include "apps/mien/overlay.h"
#include "apps/mien/progress.h"
#include "apps/mien/stage_times.h"
#include "apps/mien/video_source.h"

namespace mien::app {
namespace {

// Everything that is written per frame.
class Outputs {
 public:
  Outputs(const TrackOptions& options, const VideoInfo& info, const VideoRange& range);
  void frame(std::int64_t number, const mien_image& image, std::span<const Result> faces);
  void finish();

 private:
  void rows(std::int64_t number, const Result& face);

  Faces faces_;
  std::unique_ptr<OutputFile> curves_;
  std::unique_ptr<OutputFile> landmarks_;
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<VideoEncoder> encoder_;
};

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

void Outputs::frame(std::int64_t number, const mien_image& image, std::span<const Result> faces) {
  for (const Result& face : faces) {
    rows(number, face);
  }
  if (overlay_) {
    encoder_->write(overlay_->draw(image, faces).rgb());
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

void add_times(StageTimes& times, const Result& result) {
  std::uint64_t whole = 0;
  for (int stage = 0; stage < MIEN_STAGE_COUNT; ++stage) {
    whole += result.stage_ns[stage];
    if (result.stage_ns[stage] != 0) {
      times.add(mien_stage_name(stage), static_cast<std::int64_t>(result.stage_ns[stage]));
    }
  }
  times.add("frame", static_cast<std::int64_t>(whole));
}

void write_stats(const std::string& path, const Result& last, const StageTimes& times,
                 std::size_t tracker_bytes) {
  nlohmann::ordered_json stats;
  stats["frames"] = last.frames;
  stats["frames_with_face"] = last.face_frames;
  stats["proposal_runs"] = last.proposal_runs;
  stats["encoder_runs"] = last.encoder_runs;
  stats["tracker_bytes"] = tracker_bytes;
  stats["stages"] = nlohmann::ordered_json::object();
  for (const auto& [stage, time] : times.summary()) {
    stats["stages"][stage] = {
        {"median_ms", time.median_ms}, {"p95_ms", time.p95_ms}, {"total_ms", time.total_ms}};
  }
  OutputFile file(path);
  file.write(stats.dump(1) + "\n");
  file.finish();
}

void print_summary(const Result& last, const StageTimes& times) {
  std::fprintf(stderr, "frames %llu, with a face %llu, the proposal ran %llu times\n",
               static_cast<unsigned long long>(last.frames),
               static_cast<unsigned long long>(last.face_frames),
               static_cast<unsigned long long>(last.proposal_runs));
  for (const auto& [stage, time] : times.summary()) {
    std::fprintf(stderr, "  %-9s median %.3f ms, p95 %.3f ms\n", stage.c_str(), time.median_ms,
                 time.p95_ms);
  }
}

// Of all faces there are; of none while one is searched for.
std::vector<Result> results(const Tracker& tracker, const std::string& where) {
  std::vector<Result> faces(static_cast<std::size_t>(std::max(1, tracker.face_count())));
  check(tracker.get_result(faces.front()), where);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    check(tracker.get_face(static_cast<std::int32_t>(i), faces[i]), where);
  }
  return faces;
}

}  // namespace

void track(const TrackOptions& options) {
  const VideoRange range{options.start_s, options.duration_s};
  LoadedTracker loaded({options.models, options.tier, options.lod, options.budget_ms,
                        options.unfiltered, options.max_faces});
  if (!options.neutral.empty()) {
    load_neutral(options.neutral, loaded.tracker);
  }
  const std::unique_ptr<VideoSource> video = open_video(options.input, range);
  Outputs outputs(options, video->info(), range);
  StageTimes times;
  Result last;
  {
    Progress progress(options.quiet, video->info().frames);
    mien_image image;
    std::int64_t pts_ns = 0;
    for (std::int64_t frame = 0; video->next(image, pts_ns); ++frame) {
      const std::string where = options.input + ": frame " + std::to_string(frame);
      check(loaded.tracker.push_video(image, pts_ns), where);
      const std::vector<Result> faces = results(loaded.tracker, where);
      outputs.frame(frame, image, faces);
      last = faces.front();
      add_times(times, last);
      progress.update(frame + 1);
    }
  }
  outputs.finish();
  if (!options.stats.empty()) {
    write_stats(options.stats, last, times, loaded.tracker_bytes);
  }
  if (!options.quiet) {
    print_summary(last, times);
  }
}

}  // namespace mien::app
