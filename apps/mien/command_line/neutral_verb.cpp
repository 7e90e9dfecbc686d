// Options of `mien neutral`.
#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/command_line/option_values.h"
#include "apps/mien/tracking/neutral.h"

namespace mien::app {

void add_neutral(CLI::App& program) {
  auto* verb = program.add_subcommand("neutral", "Capture the neutral calibration of a person");
  auto options = std::make_shared<NeutralOptions>();
  verb->add_option("INPUT", options->input, "video of the neutral face, at least 2 seconds")
      ->required();
  verb->add_option("-o", options->output, "neutral file for `mien track --neutral`")->required();
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_option("--start", options->start_s, "start of the part to use, in seconds")
      ->check(non_negative_number());
  verb->add_option("--duration", options->duration_s, "length of the part to use, in seconds")
      ->check(positive_number());
  verb->add_flag("--json", options->json, "print a summary as JSON");
  verb->add_flag("--quiet", options->quiet, "print no summary");
  verb->callback([options] { neutral(*options); });
}

}  // namespace mien::app
