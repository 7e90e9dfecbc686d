// Statistics of a live run, with constant memory.
#pragma once

#include <array>
#include <cstdint>
#include <mien/mien.hpp>
#include <string>
#include <vector>

#include "apps/mien/tracking/part_times.h"

namespace mien::app {

// A histogram of times in steps of 0.1 ms up to 1 s.
class Histogram {
 public:
  void add(std::int64_t ns);
  // In ms; 0 if empty. `fraction`: 0.5 for the median.
  [[nodiscard]] double quantile(double fraction) const;
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::array<std::uint64_t, 10001> counts_{};
  std::uint64_t count_ = 0;
};

class LiveStatistics {
 public:
  // `latency_ns`: time from the arrival of the image to its packet; negative without an image.
  void frame(const Result& result, std::int64_t now_ns, std::int64_t latency_ns);

  [[nodiscard]] double frames_per_second() const { return fps_; }
  [[nodiscard]] const StageMs& stage_ms() const { return stage_ms_; }
  [[nodiscard]] const Histogram& latency() const { return latency_; }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t face_frames() const { return face_frames_; }

 private:
  std::uint64_t frames_ = 0, face_frames_ = 0;
  std::int64_t last_ns_ = 0;
  double fps_ = 0.0;  // as the next member, an average over about a second
  StageMs stage_ms_{};
  Histogram latency_;
};

}  // namespace mien::app
