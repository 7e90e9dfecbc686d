// Matches frames by time.
#include "apps/mien/compare/matching.h"

#include <algorithm>
#include <cmath>

namespace mien::app {
namespace {

constexpr double kDefaultFrameMs = 1000.0 / 30.0;

double median_interval_ms(const Curves& curves) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    intervals.push_back(curves[i].t_ms - curves[i - 1].t_ms);
  }
  if (intervals.empty()) {
    return kDefaultFrameMs;
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

// The first of the frames nearest to `t_ms`.
std::size_t nearest(const Curves& curves, double t_ms) {
  const auto by_time = [](const CurvesFrame& frame, double t) { return frame.t_ms < t; };
  auto after = std::lower_bound(curves.begin(), curves.end(), t_ms, by_time);
  if (after == curves.begin()) {
    return 0;
  }
  const double before_ms = std::prev(after)->t_ms;
  if (after == curves.end() || t_ms - before_ms <= after->t_ms - t_ms) {
    after = std::lower_bound(curves.begin(), curves.end(), before_ms, by_time);
  }
  return static_cast<std::size_t>(after - curves.begin());
}

}  // namespace

std::vector<FramePair> match_frames(const Curves& a, const Curves& b) {
  const double less_than_ms = std::max(median_interval_ms(a), median_interval_ms(b)) / 2.0;
  std::vector<FramePair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t j = nearest(b, a[i].t_ms);
    if (std::abs(a[i].t_ms - b[j].t_ms) < less_than_ms && nearest(a, b[j].t_ms) == i) {
      pairs.push_back({i, j});
    }
  }
  return pairs;
}

}  // namespace mien::app
