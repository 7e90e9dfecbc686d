#include "apps/mien/convert/convert.h"

#include <memory>

#include "apps/mien/command_line/animation_options.h"
#include "apps/mien/command_line/finite_number.h"
#include "apps/mien/command_line/verbs.h"

namespace mien::app {

void add_convert(CLI::App& program) {
  auto* verb = program.add_subcommand("convert", "Turn an animation into another format");
  auto options = std::make_shared<ConvertOptions>();
  verb->add_option("INPUT", options->input,
                   "curves, cues or motion of any format, or - for standard input")
      ->required();
  verb->add_option("OUTPUT", options->output,
                   "file whose ending says the format, or - for standard output")
      ->required();
  verb->add_option("--from", options->from, "format of INPUT (default: as its content tells)");
  verb->add_option("--to", options->to, "format of OUTPUT");
  verb->add_option("--fps", options->fps, "even frames, so many a second")
      ->check(finite(CLI::Range(0.1, 1000.0)));
  verb->add_option("--face", options->face, "only the face with this id");
  verb->add_option("--from-llf-rot", options->from_rotation,
                   "rotations of INPUT, from Live Link Face: rad, norm180 or deg (default: as the "
                   "file beside it says, or its values show)")
      ->transform(rotation_units());
  verb->add_option("--from-llf-fps", options->from_timecode_fps,
                   "frames in a second of its timecode (default: the same)")
      ->check(finite(CLI::Range(1.0, 100.0)));
  verb->add_option("--from-bvh-unit", options->from_bvh_unit,
                   "positions of INPUT, from BVH: m, cm, mm or in (default: as the size of its "
                   "skeleton shows)")
      ->transform(length_units());
  add_writing_options(*verb, options->writing);
  verb->add_flag("--json", options->json, "what was done and left out as JSON on standard error");
  verb->add_flag("--quiet", options->quiet, "no word about what was left out");
  verb->callback([options] { convert(*options); });
}

}  // namespace mien::app
