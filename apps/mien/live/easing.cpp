#include "apps/mien/live/easing.h"

#include <algorithm>

#include "formats/animation/rotation.h"

namespace mien::app {
namespace {

using formats::FaceState;
using formats::Frame;

constexpr double kHoldS = 0.5, kEaseS = 1.0, kWelcomeS = 0.2;

double smooth(double x) { return x * x * (3.0 - 2.0 * x); }

double mixed(double a, double b, double share) { return a + share * (b - a); }

Frame between(const Frame& from, const Frame& to, double share) {
  Frame made = to;
  for (std::size_t i = 0; i < made.controls.size(); ++i) {
    if (formats::driven(from.controls[i]) || formats::driven(to.controls[i])) {
      made.controls[i] =
          mixed(formats::or_zero(from.controls[i]), formats::or_zero(to.controls[i]), share);
    }
  }
  if (from.head && to.head) {
    made.head = formats::between(*from.head, *to.head, share);
  }
  if (from.position_m && to.position_m) {
    for (std::size_t i = 0; i < 3; ++i) {
      (*made.position_m)[i] = mixed((*from.position_m)[i], (*to.position_m)[i], share);
    }
  }
  return made;
}

}  // namespace

// Of the way from what was shown when the face came or went, 0..1.
double Easing::share(std::int64_t now_ns) const {
  const double since_s = static_cast<double>(now_ns - changed_ns_) * 1e-9;
  const double way =
      shown_.state == FaceState::kTracking ? since_s / kWelcomeS : (since_s - kHoldS) / kEaseS;
  return smooth(std::clamp(way, 0.0, 1.0));
}

void Easing::change(FaceState state, std::int64_t now_ns) {
  const bool tracking = state == FaceState::kTracking;
  if (tracking != (shown_.state == FaceState::kTracking)) {
    from_ =
        seen_ ? std::optional(shown_) : std::nullopt;  // the first face has nothing to come from
    changed_ns_ = now_ns;
  }
  seen_ = seen_ || tracking;
}

Frame Easing::next(const Frame& tracked) {
  change(tracked.state, tracked.time_ns);
  Frame target = tracked;
  if (seen_ && tracked.state != FaceState::kTracking) {
    target.head = formats::Angles();
    target.position_m = shown_.position_m;
  }
  shown_.state = tracked.state;
  const double way = share(tracked.time_ns);
  if (way >= 1.0) {
    from_.reset();
  }
  shown_ = from_ ? between(*from_, target, way) : target;
  return shown_;
}

}  // namespace mien::app
