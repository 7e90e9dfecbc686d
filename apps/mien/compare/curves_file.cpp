#include "apps/mien/compare/curves_file.h"

#include "apps/mien/sources/animation_file.h"

namespace mien::app {

Curves parse_curves(std::string_view text, const std::string& name,
                    const formats::LiveLinkOptions& live_link) {
  Curves curves;
  for (const formats::Frame& read : parse_animation(text, name, std::nullopt, live_link).frames) {
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

Curves read_curves(const std::string& path) {
  return parse_curves(read_whole(path), path, read_live_link_notes(path));
}

}  // namespace mien::app
