// Timestamps for samples that arrive in bursts.
#pragma once

#include <cstdint>

namespace mien::app {

// Counts samples. The earliest bursts correct the offset between the count and the clock.
class SampleClock {
 public:
  explicit SampleClock(int sample_rate) : sample_rate_(sample_rate) {}

  // The timestamp of the first of `samples` samples that arrived at `now_ns`.
  std::int64_t time_of(std::int64_t samples, std::int64_t now_ns);

 private:
  [[nodiscard]] std::int64_t duration_ns(std::int64_t samples) const {
    return samples * 1'000'000'000 / sample_rate_;
  }

  int sample_rate_;
  bool begun_ = false;
  std::int64_t begin_ns_ = 0;  // of sample 0
  std::int64_t samples_ = 0;
};

}  // namespace mien::app
