// Options of `mien track`.
#include "apps/mien/command_line/verbs.h"

#include <mien/mien.h>

#include <filesystem>
#include <memory>

#include "apps/mien/command_line/animation_options.h"
#include "apps/mien/command_line/option_values.h"
#include "apps/mien/command_line/tracker_options.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/tracking/batch.h"

namespace mien::app {
namespace {

void add_files(CLI::App& verb, TrackOptions& options) {
  verb.add_option("INPUT", options.input,
                  "video, image, audio, URL (rtsp, http, ...), or - for Y4M on standard input "
                  "(WAV with --mode audio); with --out a folder of recordings")
      ->required();
  verb.add_option("-o", options.animation.files,
                  "the animation; the ending selects the format, - is standard output; repeatable "
                  "(default: CSV on standard output)")
      ->expected(1)
      ->take_all();
  verb.add_option("--format", options.animation.formats,
                  "format, once per -o: csv, jsonl, llf, gltf, glb, bvh, roblox, visemes, rhubarb, "
                  "rhubarb-json, rhubarb-xml, rhubarb-dat")
      ->expected(1)
      ->take_all();
  add_writing_options(verb, options.animation.writing);
  add_avatar(verb, options.animation.avatar);
  verb.add_option("--landmarks", options.landmarks, "landmarks as CSV");
  verb.add_option("--overlay", options.overlay,
                  "the video with landmarks, pose and controls drawn on it");
  verb.add_option("--report", options.report,
                  "page with the clip, an animated face, curves and all exports (.html)");
  verb.add_option("--report-clip-mb", options.report_clip_mb,
                  "a larger clip is stored beside the report (default 64)")
      ->check(non_negative_number());
}

void add_audio(CLI::App& verb, TrackOptions& options) {
  verb.add_option("--audio", options.audio,
                  "audio from another file than INPUT, or - for WAV on standard input");
  verb.add_option("--mode", options.mode,
                  "use video and audio (av), video or audio (default: everything available)")
      ->transform(
          one_of<Mode>({{"av", Mode::kBoth}, {"video", Mode::kVideo}, {"audio", Mode::kAudio}}));
  verb.add_option("--av-offset-ms", options.av_offset_ms,
                  "the audio belongs to video that is this much later; negative: earlier")
      ->check(number_from(-10000.0, 10000.0));
  add_voice_strength(verb, options);
  add_field_of_view(verb, options);
  verb.add_option("--stats", options.stats, "counts and stage times as JSON");
}

void add_tracking(CLI::App& verb, TrackOptions& options) {
  add_level_options(verb, options);
  verb.add_flag("--no-filter", options.unfiltered,
                "no smoothing: the output of the decoders on each frame");
  verb.add_option("--neutral", options.neutral, "neutral calibration, written by `mien neutral`");
  verb.add_option("--max-faces", options.max_faces,
                  "faces tracked at a time, 1 to 8, each with an id (default 1)")
      ->check(integer_from(1, MIEN_MAX_FACES));
  verb.add_flag("--no-backward", options.forward_only,
                "leave the frames before a detection empty; otherwise the face is tracked backward "
                "from it, through up to 3 seconds");
  verb.add_option("--tier", options.tier, "kernel tier: ref, avx2, avx512, ...");
  verb.add_flag("--unfused", options.unfused, "run networks layer by layer");
  verb.add_option("--models", options.models, "folder of the model files");
}

void add_part(CLI::App& verb, TrackOptions& options) {
  verb.add_option("--audio-track", options.audio_track,
                  "number of the audio track; the first is 1 (default)")
      ->check(integer_from(1, 1000));
  verb.add_option("--rotate", options.rotation,
                  "clockwise rotation in degrees that makes the video upright; overrides the file")
      ->transform(one_of<int>({{"0", 0}, {"90", 90}, {"180", 180}, {"270", 270}}));
  verb.add_option("--start", options.start_s, "start of the part to track, in seconds")
      ->check(non_negative_number());
  verb.add_option("--duration", options.duration_s, "length of the part to track, in seconds")
      ->check(positive_number());
  verb.add_flag("--quiet", options.quiet, "no progress bar, no summary");
}

void add_batch(CLI::App& verb, BatchOptions& batch) {
  auto* out = verb.add_option("--out", batch.out, "folder for the outputs; INPUT is a folder");
  verb.add_option("--jobs", batch.jobs,
                  "files of a folder to process at a time (default: one per core)")
      ->check(integer_from(1, 256))
      ->needs(out);
  verb.add_flag("--reports", batch.reports, "write a report for each file of the folder as well")
      ->needs(out);
  verb.add_flag("--again", batch.again, "process files of the folder with existing outputs as well")
      ->needs(out);
  verb.add_flag("--json", batch.json, "print the summary of a folder as JSON")->needs(out);
  for (const char* one_file :
       {"-o", "--landmarks", "--overlay", "--report", "--stats", "--audio"}) {
    out->excludes(verb.get_option(one_file));
  }
}

void run(TrackOptions& options, BatchOptions& batch) {
  options.animation.writing.several_faces = options.max_faces > 1;
  options.animation.writing.audio_file =
      without_credentials(options.audio.empty() ? options.input : options.audio);
  const bool reports = batch.reports || !options.report.empty();
  options.animation.avatar_in_report = reports;
  if (options.max_faces > 1 && reports) {
    throw Failure(kExitUsage, "--max-faces: a report shows a single face");
  }
  if (batch.out.empty()) {
    if (std::filesystem::is_directory(path_of(options.input))) {
      throw Failure(kExitNoInput, options.input + ": is a folder, which requires --out");
    }
    const TrackSummary summary = track(options);
    if (!summary.lost.empty()) {
      throw Failure(kExitDamaged, summary.lost + "; the outputs contain the others");
    }
    return;
  }
  batch.folder = options.input;
  batch.each = options;
  track_folder(batch);
}

}  // namespace

void add_track(CLI::App& program) {
  auto* verb = program.add_subcommand(
      "track", "Track the face in a video from its images and audio, and write its animation");
  auto options = std::make_shared<TrackOptions>();
  auto batch = std::make_shared<BatchOptions>();
  add_files(*verb, *options);
  add_audio(*verb, *options);
  add_tracking(*verb, *options);
  add_part(*verb, *options);
  add_batch(*verb, *batch);
  verb->callback([options, batch] { run(*options, *batch); });
}

}  // namespace mien::app
