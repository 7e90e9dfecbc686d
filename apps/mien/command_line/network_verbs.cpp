// Options of `mien inspect` and `mien run`.
#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/command_line/option_values.h"
#include "apps/mien/networks/inspect.h"
#include "apps/mien/networks/run.h"

namespace mien::app {

void add_inspect(CLI::App& program) {
  auto* verb = program.add_subcommand("inspect", "Print the networks and layers of a weight file");
  auto options = std::make_shared<InspectOptions>();
  verb->add_option("FILE", options->file, "weight file (.mien)")->required();
  verb->add_flag("--json", options->json, "print JSON");
  verb->callback([options] { inspect(*options); });
}

void add_run(CLI::App& program) {
  auto* verb = program.add_subcommand("run", "Run a network of a weight file on an array");
  auto options = std::make_shared<RunOptions>();
  verb->add_option("MODEL", options->model, "weight file (.mien)")->required();
  verb->add_option("--input", options->input,
                   "input (.npy); the last axis before those of the network counts time steps")
      ->required();
  verb->add_option("--output", options->outputs, "result (.npy), once per output of the network")
      ->required();
  verb->add_option("--network", options->network,
                   "name of the network; required if the file has several");
  verb->add_option("--layout", options->layout, "axis order of maps: chw (default) or hwc")
      ->transform(one_of<MapLayout>(
          {{"chw", MapLayout::kChannelsFirst}, {"hwc", MapLayout::kChannelsLast}}));
  verb->add_option("--tier", options->tier, "kernel tier: ref, avx2, avx512, ...");
  verb->callback([options] { run_network(*options); });
}

}  // namespace mien::app
