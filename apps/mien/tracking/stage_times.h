// Median, 95th percentile and sum of the time of each stage.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mien::app {

struct StageTime {
  double median_ms;
  double p95_ms;
  double total_ms;
};

class StageTimes {
 public:
  void add(const std::string& stage, std::int64_t nanoseconds);
  std::map<std::string, StageTime> summary() const;

 private:
  std::map<std::string, std::vector<double>> ms_;
};

}  // namespace mien::app
