// Computes the overlap of squares and suppresses non-maxima.
#include "tracker/detection/squares.h"

#include <algorithm>

namespace mien::tracker {
namespace {

// Length that the intervals of two squares share along one axis.
float shared(float center_a, float side_a, float center_b, float side_b) {
  const float low = std::max(center_a - side_a / 2, center_b - side_b / 2);
  const float high = std::min(center_a + side_a / 2, center_b + side_b / 2);
  return std::max(high - low, 0.0f);
}

bool better(const Detection& a, const Detection& b) { return a.score > b.score; }

}  // namespace

float intersection_over_union(const Square& a, const Square& b) {
  const float common = shared(a.center.x, a.side, b.center.x, b.side) *
                       shared(a.center.y, a.side, b.center.y, b.side);
  const float total = a.side * a.side + b.side * b.side - common;
  return total > 0.0f ? common / total : 0.0f;
}

std::size_t suppress_non_maxima(std::span<Detection> detections, float threshold) {
  std::sort(detections.begin(), detections.end(), [](const Detection& a, const Detection& b) {
    if (a.score != b.score) {
      return a.score > b.score;
    }
    return a.square.side > b.square.side;
  });
  std::size_t kept = 0;
  for (const Detection& detection : detections) {
    const auto winners = detections.first(kept);
    const bool beaten = std::any_of(winners.begin(), winners.end(), [&](const Detection& winner) {
      return intersection_over_union(winner.square, detection.square) > threshold;
    });
    if (!beaten) {
      detections[kept++] = detection;
    }
  }
  return kept;
}

void BestDetections::offer(const Detection& detection) {
  if (count_ == memory_.size()) {
    if (count_ == 0 || !better(detection, memory_.front())) {
      return;
    }
    std::pop_heap(memory_.begin(), memory_.end(), better);
    --count_;
  }
  memory_[count_++] = detection;
  std::push_heap(memory_.begin(), memory_.begin() + static_cast<std::ptrdiff_t>(count_), better);
}

}  // namespace mien::tracker
