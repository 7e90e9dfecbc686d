#include "apps/mien/command_line/verbs.h"

#include <map>
#include <memory>

#include "apps/mien/networks/inspect.h"
#include "apps/mien/networks/run.h"

namespace mien::app {

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

}  // namespace mien::app
