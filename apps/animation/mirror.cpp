// Exchanges left and right.
#include "apps/animation/mirror.h"

#include <string>

namespace mien::animation {
namespace {

std::size_t partner(std::size_t control) {
  std::string name(formats::kArkitNames[control]);
  if (name.ends_with("Left")) {
    name.replace(name.size() - 4, 4, "Right");
  } else if (name.ends_with("Right")) {
    name.replace(name.size() - 5, 5, "Left");
  }
  return formats::index_of(name, formats::kArkitNames);
}

Angles mirrored(const Angles& angles) { return {angles.pitch, -angles.yaw, -angles.roll}; }

}  // namespace

Frame mirrored(const Frame& frame) {
  Frame result = frame;
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    result.controls[partner(i)] = frame.controls[i];
  }
  if (frame.head) {
    result.head = mirrored(*frame.head);
  }
  if (frame.position_m) {
    (*result.position_m)[0] = -(*frame.position_m)[0];
  }
  if (frame.eyes) {
    result.eyes = {mirrored((*frame.eyes)[1]), mirrored((*frame.eyes)[0])};
  }
  result.facs.clear();
  return result;
}

}  // namespace mien::animation
