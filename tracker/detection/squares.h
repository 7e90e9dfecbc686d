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

// Greedy non-maximum suppression: keeps the detection with the best score, drops those that overlap
// it by more than `threshold`, and repeats. Moves the kept detections to the front, best first, and
// returns their number.
[[nodiscard]] std::size_t suppress_non_maxima(std::span<Detection> detections, float threshold);

// Keeps the detections with the best scores, as many as fit into memory.
class BestDetections {
 public:
  explicit BestDetections(std::span<Detection> memory) : memory_(memory) {}
  void offer(const Detection& detection);
  [[nodiscard]] std::span<Detection> kept() const { return memory_.first(count_); }

 private:
  std::span<Detection> memory_;  // a heap with the worst on top
  std::size_t count_ = 0;
};

}  // namespace mien::tracker
