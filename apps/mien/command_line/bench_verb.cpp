// Options of `mien bench`.
#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/bench/bench.h"
#include "apps/mien/command_line/option_values.h"

namespace mien::app {

void add_bench(CLI::App& program) {
  auto* verb = program.add_subcommand(
      "bench", "Measure the networks, tracking of a clip, or audio processing on one core");
  auto options = std::make_shared<BenchOptions>();
  auto* model = verb->add_option("--model", options->model,
                                 "measure this network only, for example basenet_encoder");
  auto* clip = verb->add_option("--clip", options->clip,
                                "compare tracking with detection on every frame of this video")
                   ->excludes(model);
  auto* levels = verb->add_option("--levels", options->levels,
                                  "measure each level of detail on this video, stage by stage")
                     ->excludes(model)
                     ->excludes(clip);
  verb->add_option("--rounds", options->rounds,
                   "with --levels: repetitions per frame; the fastest counts (default 30)")
      ->needs(levels)
      ->check(integer_from(1, 10'000))
      ->capture_default_str();
  auto* audio = verb->add_flag("--sound", options->audio,
                               "measure audio from samples to controls, in blocks of 16 ms")
                    ->excludes(model)
                    ->excludes(clip)
                    ->excludes(levels);
  verb->add_flag("--layers", options->layers, "measure each layer or group of fused layers as well")
      ->excludes(clip)
      ->excludes(levels)
      ->excludes(audio);
  verb->add_option("--tier", options->tier,
                   "measure this kernel tier only: ref, avx2, avx512, ...");
  verb->add_flag("--unfused", options->unfused, "run networks layer by layer");
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_flag("--json", options->json, "print JSON");
  verb->callback([options] { bench(*options); });
}

}  // namespace mien::app
