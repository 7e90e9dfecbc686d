#include "apps/mien/tracking/track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "apps/mien/networks/model_files.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/outputs/outputs.h"
#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/sound_source.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/progress.h"
#include "apps/mien/tracking/loaded_tracker.h"
#include "apps/mien/tracking/stage_times.h"

namespace mien::app {
namespace {

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

void write_stats(OutputFile& file, const Result& last, const StageTimes& times,
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

// What is looked at and listened to.
struct Senses {
  bool video = false;
  std::string sound;  // where from; empty: nowhere
};

bool has_sound_in(const std::string& source) {
  return source == kStandardInput || probe_streams(source).sound;
}

Senses choose(const TrackOptions& options) {
  if (options.mode == Mode::kVideo) {
    return {.video = true, .sound = ""};
  }
  if (options.mode == Mode::kAudio && options.audio.empty() && options.input == kStandardInput) {
    return {.video = false, .sound = kStandardInput};
  }
  if (options.audio == kStandardInput && options.input == kStandardInput) {
    throw Failure(kExitUsage, "--audio -: standard input is the picture's already");
  }
  const InputStreams streams = probe_streams(options.input);
  Senses senses;
  senses.video = options.mode == Mode::kAny ? streams.video : options.mode != Mode::kAudio;
  const std::string& source = options.audio.empty() ? options.input : options.audio;
  const bool has_sound = options.audio.empty() ? streams.sound : has_sound_in(source);
  const bool demanded = options.mode != Mode::kAny || !senses.video || !options.audio.empty();
  if (demanded && !has_sound) {
    throw Failure(kExitNoSound, source + ": has no sound");
  }
  if (demanded || (has_sound && has_audionet(options.models))) {
    senses.sound = source;
  }
  return senses;
}

// One source of frames: those of a video, or 30 a second as long as there is sound.
class Frames {
 public:
  Frames(const TrackOptions& options, const VideoRange& range, const Senses& senses,
         Tracker& tracker)
      : input_(options.input), start_ns_(std::llround(range.start_s * 1e9)), tracker_(tracker) {
    if (senses.video) {
      video_ = open_video(options.input, range);
    }
    if (!senses.sound.empty()) {
      sound_.emplace(senses.sound, range);
      check(tracker.set_audio_offset(std::llround(options.av_offset_ms * 1e6)), input_);
    }
  }

  [[nodiscard]] VideoInfo info() const { return video_ ? video_->info() : VideoInfo(); }
  [[nodiscard]] const mien_image* image() const { return video_ ? &image_ : nullptr; }
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] std::string where() const { return input_ + ": frame " + std::to_string(number_); }

  void set_listener(SoundFeed::Listener listener) {
    if (sound_) {
      sound_->set_listener(std::move(listener));
    }
  }

  // Tracks the next one. False at the end.
  bool next() {
    ++number_;
    return video_ ? next_image() : next_sound();
  }

 private:
  bool next_image() {
    std::int64_t pts_ns = 0;
    if (!video_->next(image_, pts_ns)) {
      return false;
    }
    if (sound_) {
      sound_->hear_until(pts_ns, tracker_);
    }
    check(tracker_.push_video(image_, pts_ns), where());
    return true;
  }

  bool next_sound() {
    const std::int64_t pts_ns = start_ns_ + number_ * 1'000'000'000 / 30;
    sound_->hear_until(pts_ns, tracker_);
    if (!sound_->lasts_until(pts_ns)) {
      return false;
    }
    check(tracker_.advance(pts_ns), where());
    return true;
  }

  std::string input_;
  std::int64_t start_ns_;
  Tracker& tracker_;
  std::unique_ptr<VideoSource> video_;
  std::optional<SoundFeed> sound_;
  mien_image image_;
  std::int64_t number_ = -1;
};

std::vector<std::string> inputs_of(const TrackOptions& options) {
  std::vector<std::string> inputs = {options.input, options.audio, options.neutral};
  for (const std::filesystem::path& file : weight_files(models_directory(options.models))) {
    inputs.push_back(name_of(file));
  }
  return inputs;
}

std::vector<std::string> outputs_of(const TrackOptions& options) {
  std::vector<std::string> outputs = {options.landmarks, options.overlay, options.stats};
  if (!options.report.empty()) {
    outputs.push_back(options.report);
    outputs.push_back(clip_beside(options.report));
  }
  for (const AnimationTarget& target : targets(options.animation)) {
    const std::vector<std::string> files = files_of(target);
    outputs.insert(outputs.end(), files.begin(), files.end());
  }
  return outputs;
}

}  // namespace

TrackSummary track(const TrackOptions& options) {
  const VideoRange range{options.start_s, options.duration_s};
  const Senses senses = choose(options);
  if (!senses.video && !options.overlay.empty()) {
    throw Failure(kExitUsage, "--overlay: there is no picture to draw over");
  }
  LoadedTracker loaded({options.models, options.tier, options.lod, options.budget_ms,
                        options.unfiltered, options.max_faces, !senses.sound.empty(),
                        options.unfused, options.voice_strength, options.fov_degrees});
  if (!options.neutral.empty()) {
    load_neutral(options.neutral, loaded.tracker);
  }
  require_distinct_files(inputs_of(options), outputs_of(options));
  Frames frames(options, range, senses, loaded.tracker);
  Outputs outputs(options, frames.info(), range);
  std::optional<OutputFile> stats;  // before the work that would be lost
  if (!options.stats.empty()) {
    stats.emplace(options.stats);
  }
  frames.set_listener(outputs.listener());
  StageTimes times;
  Result last;
  {
    Progress progress(options.quiet, frames.info().frames);
    while (outputs.wanted() && frames.next()) {
      const std::vector<Result> faces = results(loaded.tracker, frames.where());
      outputs.frame(frames.number(), frames.image(), faces);
      last = faces.front();
      add_times(times, last);
      progress.update(frames.number() + 1);
      if (options.after_frame) {
        options.after_frame();
      }
    }
  }
  outputs.finish(times);
  if (stats) {
    write_stats(*stats, last, times, loaded.tracker_bytes);
  }
  if (!options.quiet) {
    print_summary(last, times);
  }
  return {last.frames, last.face_frames};
}

}  // namespace mien::app
