// Time spent in the stages of one frame, by the caller's clock.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>
#include <numeric>

namespace mien::tracker {

class StageTimer {
 public:
  using Clock = std::uint64_t (*)(void* user);

  StageTimer(Clock clock, void* user) : clock_(clock), user_(user) {}

  void clear() { spent_ns_ = {}; }
  [[nodiscard]] std::uint64_t spent_ns(mien_stage stage) const { return spent_ns_[stage]; }

  [[nodiscard]] std::uint64_t total_ns() const {
    return std::accumulate(spent_ns_.begin(), spent_ns_.end(), std::uint64_t{0});
  }

  // Measures the time from construction to the end of the scope.
  class Scope {
   public:
    Scope(StageTimer& timer, mien_stage stage)
        : timer_(timer), stage_(stage), started_ns_(timer.now()) {}
    ~Scope() { timer_.spent_ns_[stage_] += timer_.now() - started_ns_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageTimer& timer_;
    mien_stage stage_;
    std::uint64_t started_ns_;
  };

 private:
  [[nodiscard]] std::uint64_t now() const { return clock_ != nullptr ? clock_(user_) : 0; }

  Clock clock_;
  void* user_;
  std::array<std::uint64_t, MIEN_STAGE_COUNT> spent_ns_ = {};
};

}  // namespace mien::tracker
