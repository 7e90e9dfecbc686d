// Tracks one input and writes its outputs.
#include "apps/mien/tracking/track.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/mien/networks/model_files.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/outputs/outputs.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/system/progress.h"
#include "apps/mien/tracking/backward_fill.h"
#include "apps/mien/tracking/frames.h"
#include "apps/mien/tracking/loaded_tracker.h"
#include "apps/mien/tracking/part_times.h"
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

nlohmann::ordered_json json_of(const MediaReport& media) {
  nlohmann::ordered_json input = nlohmann::ordered_json::object();
  if (media.video) {
    input["video"] = {{"width", media.video->width},
                      {"height", media.video->height},
                      {"pixel_aspect", media.video->pixel_aspect},
                      {"rotation", media.video->rotation},
                      {"decoding_errors", media.video_decoding_errors}};
  }
  if (media.audio) {
    input["audio"] = {{"track", media.audio->track},
                      {"tracks", media.audio->tracks},
                      {"peak", media.audio->peak},
                      {"decoding_errors", media.audio->decoding_errors}};
  }
  return input;
}

void write_stats(OutputFile& file, const Result& last, const StageTimes& times,
                 std::size_t tracker_bytes, std::uint64_t filled, const MediaReport& media) {
  nlohmann::ordered_json stats;
  stats["frames"] = last.frames;
  stats["frames_with_face"] = last.face_frames + filled;
  stats["frames_filled_backward"] = filled;
  stats["proposal_runs"] = last.proposal_runs;
  stats["encoder_runs"] = last.encoder_runs;
  stats["tracker_bytes"] = tracker_bytes;
  stats["input"] = json_of(media);
  stats["stages"] = nlohmann::ordered_json::object();
  for (const auto& [stage, time] : times.summary()) {
    stats["stages"][stage] = {
        {"median_ms", time.median_ms}, {"p95_ms", time.p95_ms}, {"total_ms", time.total_ms}};
  }
  file.write(stats.dump(1) + "\n");
  file.finish();
}

void print_summary(const Result& last, std::uint64_t filled, const StageTimes& times) {
  std::fprintf(stderr, "%llu frames, %llu with a face, %llu with detection\n",
               static_cast<unsigned long long>(last.frames),
               static_cast<unsigned long long>(last.face_frames) + filled,
               static_cast<unsigned long long>(last.proposal_runs));
  std::map<std::string, StageTime> summary = times.summary();
  StageMs mean{};
  for (std::size_t stage = 0; stage < mean.size(); ++stage) {
    mean[stage] = summary[mien_stage_name(static_cast<std::int32_t>(stage))].total_ms /
                  static_cast<double>(std::max<std::uint64_t>(last.frames, 1));
  }
  std::fprintf(stderr, "%s; 95 %% within %.3f ms\n", part_times(mean, 3).c_str(),
               summary["frame"].p95_ms);
}

LoadedTracker::Options tracker_options_of(const TrackOptions& options, const InputTracks& tracks) {
  return {options.models,         options.tier,       options.lod,           options.budget_ms,
          options.unfiltered,     options.max_faces,  !tracks.sound.empty(), options.unfused,
          options.voice_strength, options.fov_degrees};
}

std::vector<std::string> inputs_of(const TrackOptions& options) {
  std::vector<std::string> inputs = {options.input, options.audio, options.neutral,
                                     options.animation.avatar};
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

// `last`: the result of the latest frame.
void track_frames(const TrackOptions& options, const Tracker& tracker, Frames& frames,
                  Outputs& outputs, BackwardFill& backward, StageTimes& times, Result& last) {
  Progress progress(options.quiet, frames.info().frames);
  while (outputs.wanted() && frames.next()) {
    std::vector<Result> faces = results(tracker, frames.where());
    last = faces.front();
    if (!options.forward_only && frames.image() != nullptr) {
      backward.add(frames.number(), *frames.image(), std::move(faces));
    } else {
      outputs.frame(frames.number(), frames.image(), faces);
    }
    add_times(times, last);
    progress.update(frames.number() + 1);
    if (options.after_frame) {
      options.after_frame();
    }
  }
}

}  // namespace

TrackSummary track(const TrackOptions& options) {
  const VideoRange range = range_of(options);
  const InputTracks tracks = choose(options);
  if (!tracks.video && (!options.overlay.empty() || options.rotation)) {
    throw Failure(kExitUsage, options.overlay.empty() ? "--rotate: no video to rotate"
                                                      : "--overlay: no video to draw on");
  }
  const LoadedTracker::Options tracker_options = tracker_options_of(options, tracks);
  LoadedTracker loaded(tracker_options);
  if (!options.neutral.empty()) {
    load_neutral(options.neutral, loaded.tracker);
  }
  require_distinct_files(inputs_of(options), outputs_of(options));
  Frames frames(options, tracks, loaded.tracker);
  Outputs outputs(options, frames.info(), range);
  // Opened first, so that an unwritable file fails before the work.
  std::optional<OutputFile> stats;
  if (!options.stats.empty()) {
    stats.emplace(options.stats);
  }
  frames.set_listener(outputs.listener());
  BackwardFill backward(
      tracker_options, options.neutral,
      [&](std::int64_t number, const mien_image* image, std::span<const Result> faces) {
        outputs.frame(number, image, faces);
      });
  StageTimes times;
  Result last;
  try {
    track_frames(options, loaded.tracker, frames, outputs, backward, times, last);
  } catch (...) {
    backward.finish();  // rows before a damaged part are right
    throw;
  }
  backward.finish();
  MediaReport media = frames.report();  // before the outputs are published: an allocation may fail
  outputs.finish(times);
  if (stats) {
    write_stats(*stats, last, times, loaded.tracker_bytes, backward.filled(), media);
  }
  for (const std::string& note : media.notes) {
    std::fprintf(stderr, "mien: note: %s\n", printable(note).c_str());
  }
  if (!options.quiet) {
    print_summary(last, backward.filled(), times);
  }
  return {last.frames, last.face_frames + backward.filled(), std::move(media.lost),
          std::move(media.notes)};
}

}  // namespace mien::app
