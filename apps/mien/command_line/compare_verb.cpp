// Options of `mien compare`.
#include "apps/mien/command_line/verbs.h"

#include <memory>

#include "apps/mien/compare/compare.h"

namespace mien::app {

void add_compare(CLI::App& program) {
  auto* verb = program.add_subcommand("compare",
                                      "Create a page to compare two animations of the same video");
  auto options = std::make_shared<CompareOptions>();
  verb->add_option("A", options->a, "first animation, in any format")->required();
  verb->add_option("B", options->b, "second animation of the same video, in any format")
      ->required();
  verb->add_option("--video", options->video, "the video of both animations");
  verb->add_option("-o", options->page, "the page (.html)")->required();
  verb->add_flag("--json", options->json, "print the summary as JSON");
  verb->add_flag("--quiet", options->quiet, "print no summary");
  verb->callback([options] { compare(*options); });
}

}  // namespace mien::app
