#include "engine/arena_plan.h"

namespace mien::engine {
namespace {

std::size_t aligned(std::size_t bytes) {
  return (bytes + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
}

// The placed intervals that are still alive, by offset.
class LiveSet {
 public:
  explicit LiveSet(const Interval* intervals) : intervals_(intervals) {}

  void drop_dead(std::uint32_t now) {
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (intervals_[live_[i]].dies >= now) {
        live_[kept++] = live_[i];
      }
    }
    count_ = kept;
  }

  // The lowest gap that holds `bytes`; `at` is where in the order it lies.
  std::size_t lowest_gap(std::size_t bytes, std::uint32_t& at) const {
    std::size_t begin = 0;
    for (at = 0; at < count_; ++at) {
      const Interval& next = intervals_[live_[at]];
      if (next.offset >= begin && next.offset - begin >= bytes) {
        return begin;
      }
      begin = next.offset + aligned(next.bytes);
    }
    return begin;
  }

  void insert(std::uint32_t at, std::uint32_t interval) {
    for (std::uint32_t i = count_; i > at; --i) {
      live_[i] = live_[i - 1];
    }
    live_[at] = interval;
    ++count_;
  }

 private:
  const Interval* intervals_;
  std::uint32_t live_[formats::kMaxLayers + 1] = {};
  std::uint32_t count_ = 0;
};

}  // namespace

std::size_t place(Interval* intervals, std::uint32_t count) {
  LiveSet live(intervals);
  std::size_t total = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    live.drop_dead(intervals[i].born);
    std::uint32_t at = 0;
    const std::size_t bytes = aligned(intervals[i].bytes);
    intervals[i].offset = live.lowest_gap(bytes, at);
    live.insert(at, i);
    const std::size_t end = intervals[i].offset + bytes;
    total = end > total ? end : total;
  }
  return total;
}

}  // namespace mien::engine
