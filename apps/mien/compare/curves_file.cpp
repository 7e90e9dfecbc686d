// Reads animations of any format as curves.
#include "apps/mien/compare/curves_file.h"

#include "apps/mien/sources/animation_file.h"

namespace mien::app {
namespace {

Curves curves_of(const formats::Clip& clip) {
  Curves curves;
  for (const formats::Frame& read : clip.frames) {
    CurvesFrame frame;
    frame.t_ms = read.time_ms();
    if (read.head) {
      frame.head = {read.head->pitch, read.head->yaw, read.head->roll};
    }
    frame.controls = read.controls;
    curves.push_back(frame);
  }
  return curves;
}

}  // namespace

Curves parse_curves(std::string_view text, const std::string& name,
                    const formats::ReadOptions& options) {
  return curves_of(parse_animation(text, name, std::nullopt, options));
}

Curves read_curves(const std::string& path, bool quiet) {
  const formats::Clip clip =
      parse_animation(read_whole(path), path, std::nullopt, read_options_for(path));
  if (!quiet) {
    print_notes(path, clip);
  }
  return curves_of(clip);
}

}  // namespace mien::app
