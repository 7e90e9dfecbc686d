// Holds and eases faces that are lost or found.
#include "apps/mien/live/easing.h"

#include <algorithm>

#include "apps/animation/rotation.h"

namespace mien::app {
namespace {

using animation::FaceState;
using animation::Frame;

constexpr double kHoldS = 0.5, kEaseS = 1.0, kFadeInS = 0.2;

double smooth(double x) { return x * x * (3.0 - 2.0 * x); }

double mixed(double a, double b, double fraction) { return a + fraction * (b - a); }

Frame between(const Frame& from, const Frame& to, double fraction) {
  Frame result = to;
  for (std::size_t i = 0; i < result.controls.size(); ++i) {
    if (formats::driven(from.controls[i]) || formats::driven(to.controls[i])) {
      result.controls[i] =
          mixed(formats::or_zero(from.controls[i]), formats::or_zero(to.controls[i]), fraction);
    }
  }
  if (from.head && to.head) {
    result.head = animation::between(*from.head, *to.head, fraction);
  }
  if (from.position_m && to.position_m) {
    for (std::size_t i = 0; i < 3; ++i) {
      (*result.position_m)[i] = mixed((*from.position_m)[i], (*to.position_m)[i], fraction);
    }
  }
  return result;
}

}  // namespace

// The progress of the transition since the state changed, 0..1.
double Easing::progress(std::int64_t now_ns) const {
  const double since_s = static_cast<double>(now_ns - changed_ns_) * 1e-9;
  const double way =
      output_.state == FaceState::kTracking ? since_s / kFadeInS : (since_s - kHoldS) / kEaseS;
  return smooth(std::clamp(way, 0.0, 1.0));
}

void Easing::change(FaceState state, std::int64_t now_ns) {
  const bool tracking = state == FaceState::kTracking;
  if (tracking != (output_.state == FaceState::kTracking)) {
    from_ = had_face_ ? std::optional(output_) : std::nullopt;  // the first face appears at once
    changed_ns_ = now_ns;
  }
  had_face_ = had_face_ || tracking;
}

Frame Easing::next(const Frame& tracked) {
  change(tracked.state, tracked.time_ns);
  Frame target = tracked;
  if (had_face_ && tracked.state != FaceState::kTracking) {
    target.head = animation::Angles();
    target.position_m = output_.position_m;
  }
  output_.state = tracked.state;
  const double way = progress(tracked.time_ns);
  if (way >= 1.0) {
    from_.reset();
  }
  output_ = from_ ? between(*from_, target, way) : target;
  return output_;
}

}  // namespace mien::app
