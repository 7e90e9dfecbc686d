// Places maps in the arena by first fit.
#include "engine/arena_plan.h"

namespace mien::engine {

std::size_t ArenaPlan::place(std::size_t bytes, std::uint32_t first_step, std::uint32_t last_step) {
  drop_expired(first_step);
  std::size_t begin = 0;
  const std::uint32_t at = lowest_gap(aligned(bytes), begin);
  for (std::uint32_t i = count_++; i > at; --i) {
    live_[i] = live_[i - 1];
  }
  const std::size_t end = begin + aligned(bytes);
  live_[at] = {begin, end, last_step};
  bytes_ = end > bytes_ ? end : bytes_;
  return begin;
}

void ArenaPlan::drop_expired(std::uint32_t now) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    if (live_[i].last_step >= now) {
      live_[kept++] = live_[i];
    }
  }
  count_ = kept;
}

// Finds the lowest `begin` with `bytes` free bytes; returns the index of the live map behind it.
std::uint32_t ArenaPlan::lowest_gap(std::size_t bytes, std::size_t& begin) const {
  begin = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    if (live_[i].begin - begin >= bytes) {
      return i;
    }
    begin = live_[i].end;
  }
  return count_;
}

}  // namespace mien::engine
