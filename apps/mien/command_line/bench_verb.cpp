#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/bench/bench.h"

namespace mien::app {

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
  verb->add_option("--rounds", options->rounds,
                   "with --levels: how often each frame is timed; the fastest counts")
      ->needs(levels)
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
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

}  // namespace mien::app
