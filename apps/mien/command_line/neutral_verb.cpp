#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/command_line/finite_number.h"
#include "apps/mien/tracking/neutral.h"

namespace mien::app {

void add_neutral(CLI::App& program) {
  auto* verb = program.add_subcommand("neutral", "Capture what a person's face shows at rest");
  auto options = std::make_shared<NeutralOptions>();
  verb->add_option("INPUT", options->input, "video of the neutral face, 2 seconds or more")
      ->required();
  verb->add_option("-o", options->output, "file for `mien track --neutral`")->required();
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_option("--start", options->start_s, "seconds to skip")
      ->check(finite(CLI::NonNegativeNumber));
  verb->add_option("--duration", options->duration_s, "seconds to look at")
      ->check(finite(CLI::PositiveNumber));
  verb->add_flag("--json", options->json, "what was captured, as JSON");
  verb->add_flag("--quiet", options->quiet, "no summary");
  verb->callback([options] { neutral(*options); });
}

}  // namespace mien::app
