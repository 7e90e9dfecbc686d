// Reads animations of any format as curves.
#include "apps/mien/compare/curves_file.h"

#include "apps/mien/sources/animation_file.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

// Every frame occupies all controls in memory and in the page, however short its line is.
constexpr std::size_t kMaxFrames = 216'000;  // two hours at 30 frames per second

Curves curves_of(const animation::Clip& clip, const std::string& name) {
  if (clip.frames.size() > kMaxFrames) {
    throw Failure(kExitNoInput, name + ": too many frames to compare (got " +
                                    std::to_string(clip.frames.size()) + ", expected at most " +
                                    std::to_string(kMaxFrames) + ")");
  }
  Curves curves;
  for (const animation::Frame& read : clip.frames) {
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
                    const animation::ReadOptions& options) {
  return curves_of(parse_animation(text, name, std::nullopt, options), name);
}

Curves read_curves(const std::string& path, bool quiet) {
  const animation::Clip clip =
      parse_animation(read_whole(path), path, std::nullopt, read_options_for(path));
  if (!quiet) {
    print_notes(path, clip);
  }
  return curves_of(clip, path);
}

}  // namespace mien::app
