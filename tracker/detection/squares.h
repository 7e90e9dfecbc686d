// Candidate squares for faces: overlap and non-maximum suppression.
#pragma once

#include <cstddef>
#include <span>

#include "tracker/geometry/geometry.h"

namespace mien::tracker {

struct Detection {
  Square square;
  float score = 0.0f;  // 0..1
  float roll = 0.0f;   // radians clockwise, of the search that found it
};

// Common area of two squares over the area of their union, 0..1; 0 when either is empty.
[[nodiscard]] float intersection_over_union(const Square& a, const Square& b);

// Greedy non-maximum suppression: keeps the best-scored candidate, drops what overlaps it by more
// than `threshold`, and so on. Reorders `candidates` so that the kept ones come first, best first;
// returns how many these are.
[[nodiscard]] std::size_t suppress_non_maxima(std::span<Detection> detections, float threshold);

// Keeps the best-scored of the candidates offered, as many as there is room for.
class BestDetections {
 public:
  explicit BestDetections(std::span<Detection> memory) : memory_(memory) {}
  void offer(const Detection& detection);
  [[nodiscard]] std::span<Detection> kept() const { return memory_.first(count_); }

 private:
  std::span<Detection> memory_;  // a heap, the worst on top
  std::size_t count_ = 0;
};

}  // namespace mien::tracker
