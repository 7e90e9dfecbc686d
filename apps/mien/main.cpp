// mien: facial animation from video and sound. docs/cli.md describes the verbs, options and exit
// codes.
#include <mien/mien.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>

#include "apps/mien/bench.h"
#include "apps/mien/compare/compare.h"
#include "apps/mien/failure.h"
#include "apps/mien/inspect.h"
#include "apps/mien/neutral.h"
#include "apps/mien/run.h"
#include "apps/mien/track.h"

namespace mien::app {
namespace {

void add_track(CLI::App& program) {
  auto* verb = program.add_subcommand(
      "track", "Track the face in a video, by picture and sound, and write its curves");
  auto options = std::make_shared<TrackOptions>();
  verb->add_option("INPUT", options->input,
                   "video, image, sound, .wav, .y4m, or - for Y4M on standard input, WAV with "
                   "--mode audio")
      ->required();
  verb->add_option("-o", options->curves, "curves as CSV (default: standard output)");
  verb->add_option("--landmarks", options->landmarks, "landmarks as CSV");
  verb->add_option("--overlay", options->overlay, "video with what was tracked drawn over it");
  verb->add_option(
      "--audio", options->audio,
      "file with the sound, or - for WAV on standard input (default: the input's own)");
  verb->add_option("--mode", options->mode, "av, video or audio; default: what there is of both")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Mode>{
          {"av", Mode::kBoth}, {"video", Mode::kVideo}, {"audio", Mode::kAudio}}));
  verb->add_option("--av-offset-ms", options->av_offset_ms,
                   "the sound belongs to pictures so much later than it says")
      ->check(CLI::Range(-10000.0, 10000.0));
  verb->add_option("--stats", options->stats, "counts and stage times as JSON");
  verb->add_option("--lod", options->lod,
                   "level of detail: 1 (cheapest) to 4, or auto; default: the highest there is")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, int>{{"1", 1}, {"2", 2}, {"3", 3}, {"4", 4}, {"auto", 0}}));
  verb->add_option("--budget-ms", options->budget_ms, "of --lod auto: time per frame on average")
      ->check(CLI::Range(0.01, 1e6));
  verb->add_flag("--no-filter", options->unfiltered, "curves as the networks answer");
  verb->add_option("--neutral", options->neutral, "what the face shows at rest, by `mien neutral`");
  verb->add_option("--max-faces", options->max_faces, "faces followed at once, each with an id")
      ->check(CLI::Range(1, MIEN_MAX_FACES));
  verb->add_option("--tier", options->tier, "kernel tier: ref, avx2, avx512, ...");
  verb->add_flag("--unfused", options->unfused, "networks run layer by layer");
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_option("--start", options->start_s, "seconds to skip")->check(CLI::NonNegativeNumber);
  verb->add_option("--duration", options->duration_s, "seconds to track")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--quiet", options->quiet, "no progress bar, no summary");
  verb->callback([options] { track(*options); });
}

void add_neutral(CLI::App& program) {
  auto* verb = program.add_subcommand("neutral", "Capture what a person's face shows at rest");
  auto options = std::make_shared<NeutralOptions>();
  verb->add_option("INPUT", options->input, "video of the neutral face, 2 seconds or more")
      ->required();
  verb->add_option("-o", options->output, "file for `mien track --neutral`")->required();
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_option("--start", options->start_s, "seconds to skip")->check(CLI::NonNegativeNumber);
  verb->add_option("--duration", options->duration_s, "seconds to look at")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--quiet", options->quiet, "no summary");
  verb->callback([options] { neutral(*options); });
}

void add_inspect(CLI::App& program) {
  auto* verb = program.add_subcommand("inspect", "Print what is in a weight file");
  auto options = std::make_shared<InspectOptions>();
  verb->add_option("FILE", options->file, "weight file (.mien)")->required();
  verb->add_flag("--json", options->json, "as JSON");
  verb->callback([options] { inspect(*options); });
}

void add_run(CLI::App& program) {
  auto* verb = program.add_subcommand("run", "Run a network of a weight file on an array");
  auto options = std::make_shared<RunOptions>();
  verb->add_option("MODEL", options->model, "weight file (.mien)")->required();
  verb->add_option("--input", options->input, "array (.npy); axes in front of a map count steps")
      ->required();
  verb->add_option("--output", options->outputs, "array (.npy), once for each output")->required();
  verb->add_option("--network", options->network, "which of several networks");
  verb->add_option("--layout", options->layout, "of maps: chw (default) or hwc")
      ->transform(CLI::CheckedTransformer(std::map<std::string, MapLayout>{
          {"chw", MapLayout::kChannelsFirst}, {"hwc", MapLayout::kChannelsLast}}));
  verb->add_option("--tier", options->tier, "kernel tier: ref, avx2, avx512, ...");
  verb->callback([options] { run_network(*options); });
}

void add_bench(CLI::App& program) {
  auto* verb = program.add_subcommand(
      "bench", "Time the networks, tracking a clip, or hearing, on one core");
  auto options = std::make_shared<BenchOptions>();
  auto* model =
      verb->add_option("--model", options->model, "one network only, for instance basenet_encoder");
  auto* clip =
      verb->add_option("--clip", options->clip, "video: following the face against searching it")
          ->excludes(model);
  auto* levels = verb->add_option("--levels", options->levels,
                                  "video: a frame at each level of detail, stage by stage")
                     ->excludes(model)
                     ->excludes(clip);
  auto* sound =
      verb->add_flag("--sound", options->sound, "hearing: from samples to controls, by 16 ms")
          ->excludes(model)
          ->excludes(clip)
          ->excludes(levels);
  verb->add_flag("--layers", options->layers, "also each layer, or what runs fused, by itself")
      ->excludes(clip)
      ->excludes(levels)
      ->excludes(sound);
  verb->add_option("--tier", options->tier, "one tier only: ref, avx2, avx512, ...");
  verb->add_flag("--unfused", options->unfused, "networks run layer by layer");
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_flag("--json", options->json, "as JSON");
  verb->callback([options] { bench(*options); });
}

void add_compare(CLI::App& program) {
  auto* verb = program.add_subcommand("compare", "Make a page to judge two files of curves by");
  auto options = std::make_shared<CompareOptions>();
  verb->add_option("A", options->a, "curves (.csv)")->required();
  verb->add_option("B", options->b, "curves of the same video (.csv)")->required();
  verb->add_option("--video", options->video, "the video that they were made from");
  verb->add_option("-o", options->page, "the page (.html)")->required();
  verb->add_flag("--quiet", options->quiet, "no summary");
  verb->callback([options] { compare(*options); });
}

int run(int argc, char** argv) {
  CLI::App program("Facial animation from video and sound, in real time, on a CPU", "mien");
  program.set_version_flag("--version", mien_version());
  program.require_subcommand(1);
  add_track(program);
  add_neutral(program);
  add_inspect(program);
  add_run(program);
  add_bench(program);
  add_compare(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return kExitOk;
}

}  // namespace
}  // namespace mien::app

int main(int argc, char** argv) {
  // A reader that goes away shows as a failed write, with a message, not as a silent death.
  signal(SIGPIPE, SIG_IGN);
  try {
    return mien::app::run(argc, argv);
  } catch (const mien::app::Failure& failure) {
    std::fprintf(stderr, "mien: %s\n", failure.what());
    return failure.code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mien: %s\n", error.what());
    return mien::app::kExitInternal;
  }
}
