// Draws the progress line.
#include "apps/mien/system/progress.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "apps/mien/system/terminal.h"

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);
constexpr int kBarCells = 30;

}  // namespace

Progress::Progress(bool quiet, std::optional<std::int64_t> total, const char* unit)
    : enabled_(!quiet && error_is_terminal()), total_(total), unit_(unit), started_(Clock::now()) {}

Progress::~Progress() {
  if (enabled_) {
    std::fputs("\r\033[K", stderr);
  }
}

void Progress::update(std::int64_t done, std::int64_t frames) {
  const auto now = Clock::now();
  if (!enabled_ || now - drawn_ < kRedrawEvery) {
    return;
  }
  drawn_ = now;
  const double seconds = std::chrono::duration<double>(now - started_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(frames) / seconds : 0.0;
  if (!total_) {
    std::fprintf(stderr, "\r%lld %s, %.0f frames per second\033[K", static_cast<long long>(done),
                 unit_, rate);
    return;
  }
  const double fraction = std::min(1.0, static_cast<double>(done) / static_cast<double>(*total_));
  std::string bar(kBarCells, '.');
  std::fill_n(bar.begin(), static_cast<std::size_t>(fraction * kBarCells), '#');
  std::fprintf(stderr, "\r[%s] %3.0f %%  %lld/%lld %s, %.0f frames per second\033[K", bar.c_str(),
               fraction * 100.0, static_cast<long long>(done), static_cast<long long>(*total_),
               unit_, rate);
}

}  // namespace mien::app
