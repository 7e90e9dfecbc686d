// Writes BVH.
#include "apps/animation/bvh.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "apps/animation/numbers.h"
#include "apps/animation/resample.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

constexpr int kDecimals = 6;
constexpr double kHeadLength_m = 0.1;  // shows readers the unit
constexpr double kDegrees = 180.0 / std::numbers::pi;

using Vector = std::array<double, 3>;

class BvhWriter : public WholeClipWriter {
 public:
  explicit BvhWriter(LengthUnit unit) : metres_(metres(unit)) {}

 protected:
  std::string whole(const FrameSequence& frames) override {
    const double step_s = mean_step_s(frames);
    if (evenly_spaced(frames)) {
      return with_step(frames, step_s);
    }
    return with_step(resampled(frames, 1.0 / step_s, frames.first_time_ns()), step_s);
  }

 private:
  std::string with_step(const FrameSequence& even, double step_s) const {
    std::string text =
        "HIERARCHY\n"
        "ROOT Head\n"
        "{\n"
        "\tOFFSET 0.0 0.0 0.0\n"
        "\tCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
        "\tEnd Site\n"
        "\t{\n"
        "\t\tOFFSET 0.0 " +
        shortest(kHeadLength_m / metres_) +
        " 0.0\n"
        "\t}\n"
        "}\n"
        "MOTION\n"
        "Frames: " +
        std::to_string(even.size()) + "\nFrame Time: " + fixed(step_s, 9) + "\n";
    Angles head;
    Vector position{};
    for (const Frame& frame : even) {
      head = frame.head.value_or(head);
      position = frame.position_m.value_or(position);
      for (const double coordinate_m : position) {
        text += fixed(coordinate_m / metres_, kDecimals) + " ";
      }
      text += fixed(kDegrees * head.yaw, kDecimals) + " " +
              fixed(kDegrees * head.pitch, kDecimals) + " " +
              fixed(kDegrees * head.roll, kDecimals) + "\n";
    }
    return text;
  }

  double metres_;  // per unit
};

}  // namespace

std::unique_ptr<AnimationWriter> bvh_writer(LengthUnit unit) {
  return std::make_unique<BvhWriter>(unit);
}

}  // namespace mien::animation
