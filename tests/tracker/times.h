// Percentiles of many times without storing them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace mien::tests {

// A histogram of microseconds with bins of 1 % width.
class Times {
 public:
  void add(double us) {
    const double bin = std::log(std::max(us, 1.0)) / kWidth;
    ++counts_[std::min(static_cast<std::size_t>(bin), counts_.size() - 1)];
    ++count_;
    worst_ = std::max(worst_, us);
  }

  [[nodiscard]] double percentile(double fraction) const {
    auto left = static_cast<std::int64_t>(fraction * static_cast<double>(count_));
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      left -= counts_[i];
      if (left < 0) {
        // The centre of the bin may exceed the maximum.
        return std::min(std::exp((static_cast<double>(i) + 0.5) * kWidth), worst_);
      }
    }
    return worst_;
  }
  [[nodiscard]] double worst() const { return worst_; }

 private:
  static constexpr double kWidth = 0.01;
  std::array<std::int64_t, 1800> counts_{};  // up to a minute
  std::int64_t count_ = 0;
  double worst_ = 0.0;
};

}  // namespace mien::tests
