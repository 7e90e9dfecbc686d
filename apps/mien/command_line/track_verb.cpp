#include "apps/mien/command_line/verbs.h"

#include <mien/mien.h>

#include <filesystem>
#include <map>
#include <memory>

#include "apps/mien/command_line/animation_options.h"
#include "apps/mien/command_line/finite_number.h"
#include "apps/mien/command_line/tracker_options.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/shown.h"
#include "apps/mien/tracking/batch.h"

namespace mien::app {

void add_track(CLI::App& program) {
  auto* verb = program.add_subcommand(
      "track", "Track the face in a video, by picture and sound, and write its curves");
  auto options = std::make_shared<TrackOptions>();
  auto batch = std::make_shared<BatchOptions>();
  verb->add_option("INPUT", options->input,
                   "video, image, sound, .wav, .y4m, URL (rtsp, http, ...), or - for Y4M on "
                   "standard input, WAV with "
                   "--mode audio; or a folder of them, with --out")
      ->required();
  verb->add_option("-o", options->animation.files,
                   "file whose ending says the format, - for standard output; as often as wanted "
                   "(default: CSV on standard output)")
      ->expected(1)
      ->take_all();
  verb->add_option("--format", options->animation.formats,
                   "once for each -o: csv, jsonl, llf, gltf, glb, bvh, roblox, visemes, rhubarb, "
                   "rhubarb-json, rhubarb-xml, rhubarb-dat")
      ->expected(1)
      ->take_all();
  add_writing_options(*verb, options->animation.writing);
  verb->add_option("--landmarks", options->landmarks, "landmarks as CSV");
  verb->add_option("--overlay", options->overlay, "video with what was tracked drawn over it");
  verb->add_option("--report", options->report,
                   "page with the clip, an animated face, the curves and all exports (.html)");
  verb->add_option("--report-clip-mb", options->report_clip_mb,
                   "a larger clip is put beside the report (default: 64)")
      ->check(finite(CLI::NonNegativeNumber));
  verb->add_option(
      "--audio", options->audio,
      "file with the sound, or - for WAV on standard input (default: the input's own)");
  verb->add_option("--mode", options->mode, "av, video or audio; default: what there is of both")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Mode>{
          {"av", Mode::kBoth}, {"video", Mode::kVideo}, {"audio", Mode::kAudio}}));
  verb->add_option("--av-offset-ms", options->av_offset_ms,
                   "the sound belongs to pictures so much later than it says")
      ->check(finite(CLI::Range(-10000.0, 10000.0)));
  add_voice_strength(*verb, *options);
  add_field_of_view(*verb, *options);
  verb->add_option("--stats", options->stats, "counts and stage times as JSON");
  add_level_options(*verb, *options);
  verb->add_flag("--no-filter", options->unfiltered, "curves as the networks answer");
  verb->add_option("--neutral", options->neutral, "what the face shows at rest, by `mien neutral`");
  verb->add_option("--max-faces", options->max_faces, "faces followed at once, each with an id")
      ->check(CLI::Range(1, MIEN_MAX_FACES));
  verb->add_option("--tier", options->tier, "kernel tier: ref, avx2, avx512, ...");
  verb->add_flag("--unfused", options->unfused, "networks run layer by layer");
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_option("--audio-track", options->audio_track,
                   "number of the audio track to use; the first is 1 (default)")
      ->check(CLI::Range(1, 1000));
  verb->add_option("--rotate", options->rotation,
                   "degrees clockwise that make the video upright, whatever it says itself")
      ->check(CLI::IsMember({0, 90, 180, 270}));
  verb->add_option("--start", options->start_s, "seconds to skip")
      ->check(finite(CLI::NonNegativeNumber));
  verb->add_option("--duration", options->duration_s, "seconds to track")
      ->check(finite(CLI::PositiveNumber));
  verb->add_flag("--quiet", options->quiet, "no progress bar, no summary");
  auto* out =
      verb->add_option("--out", batch->out, "folder for the outputs when INPUT is a folder");
  verb->add_option("--jobs", batch->jobs, "files of a folder at once (default: one a core)")
      ->check(CLI::Range(1, 256))
      ->needs(out);
  verb->add_flag("--reports", batch->reports, "a report of each file of the folder, too")
      ->needs(out);
  verb->add_flag("--again", batch->again, "also files of the folder that are done already")
      ->needs(out);
  verb->add_flag("--json", batch->json, "the summary of a folder as JSON")->needs(out);
  for (const char* one_file :
       {"-o", "--landmarks", "--overlay", "--report", "--stats", "--audio"}) {
    out->excludes(verb->get_option(one_file));
  }
  verb->callback([options, batch] {
    options->animation.writing.several_faces = options->max_faces > 1;
    options->animation.writing.audio_file =
        without_credentials(options->audio.empty() ? options->input : options->audio);
    if (options->max_faces > 1 && (batch->reports || !options->report.empty())) {
      throw Failure(kExitUsage, "a report shows one face; follow one");
    }
    if (batch->out.empty()) {
      if (std::filesystem::is_directory(path_of(options->input))) {
        throw Failure(kExitNoInput, options->input + ": is a folder; --out says where to");
      }
      const TrackSummary summary = track(*options);
      if (!summary.lost.empty()) {
        throw Failure(kExitDamaged, summary.lost + "; the outputs have the rest");
      }
      return;
    }
    batch->folder = options->input;
    batch->each = *options;
    track_folder(*batch);
  });
}

}  // namespace mien::app
