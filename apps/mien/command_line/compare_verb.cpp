#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/compare/compare.h"

namespace mien::app {

void add_compare(CLI::App& program) {
  auto* verb = program.add_subcommand("compare", "Make a page to judge two files of curves by");
  auto options = std::make_shared<CompareOptions>();
  verb->add_option("A", options->a, "curves (.csv)")->required();
  verb->add_option("B", options->b, "curves of the same video (.csv)")->required();
  verb->add_option("--video", options->video, "the video that they were made from");
  verb->add_option("-o", options->page, "the page (.html)")->required();
  verb->add_flag("--json", options->json, "the summary as JSON");
  verb->add_flag("--quiet", options->quiet, "no summary");
  verb->callback([options] { compare(*options); });
}

}  // namespace mien::app
