// Options of `mien convert`.
#include "apps/mien/convert/convert.h"

#include <cstdint>
#include <memory>

#include "apps/mien/command_line/animation_options.h"
#include "apps/mien/command_line/option_values.h"
#include "apps/mien/command_line/verbs.h"

namespace mien::app {

void add_convert(CLI::App& program) {
  auto* verb = program.add_subcommand("convert", "Convert an animation to another format");
  auto options = std::make_shared<ConvertOptions>();
  verb->add_option("INPUT", options->input, "animation in any format, or - for standard input")
      ->required();
  verb->add_option("OUTPUT", options->output,
                   "file whose ending selects the format, or - for standard output")
      ->required();
  verb->add_option("--from", options->from, "format of INPUT (default: detected from its content)");
  verb->add_option("--to", options->to, "format of OUTPUT");
  verb->add_option("--fps", options->fps,
                   "resample to this number of frames per second, 0.1 to 1000")
      ->check(number_from(0.1, 1000.0));
  verb->add_option("--face", options->face, "keep only the face with this id")
      ->check(number<std::int64_t>("an integer", [](std::int64_t) { return true; }));
  verb->add_option("--from-llf-rot", options->from_rotation,
                   "unit of the rotations of INPUT (Live Link Face): rad, norm180 or deg (default: "
                   "from INPUT.json, or detected)")
      ->transform(rotation_units());
  verb->add_option("--from-llf-fps", options->from_timecode_fps,
                   "frames per second of the timecode of INPUT (Live Link Face), 1 to 100 "
                   "(default: from INPUT.json, or detected)")
      ->check(number_from(1.0, 100.0));
  verb->add_option("--from-bvh-unit", options->from_bvh_unit,
                   "unit of the positions of INPUT (BVH): m, cm, mm or in (default: detected from "
                   "the size of the skeleton)")
      ->transform(length_units());
  add_writing_options(*verb, options->writing);
  add_avatar(*verb, options->avatar);
  verb->add_flag("--json", options->json,
                 "print a summary with omitted data to standard error as JSON");
  verb->add_flag("--quiet", options->quiet, "print no notes about omitted data");
  verb->callback([options] { convert(*options); });
}

}  // namespace mien::app
