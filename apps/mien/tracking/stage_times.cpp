// Collects stage times.
#include "apps/mien/tracking/stage_times.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace mien::app {

void StageTimes::add(const std::string& stage, std::int64_t nanoseconds) {
  ms_[stage].push_back(static_cast<double>(nanoseconds) * 1e-6);
}

std::map<std::string, StageTime> StageTimes::summary() const {
  std::map<std::string, StageTime> summary;
  for (auto [stage, times] : ms_) {
    std::sort(times.begin(), times.end());
    const std::size_t last = times.size() - 1;
    summary[stage] = {times[last / 2], times[last * 95 / 100],
                      std::accumulate(times.begin(), times.end(), 0.0)};
  }
  return summary;
}

}  // namespace mien::app
