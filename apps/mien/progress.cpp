#include "apps/mien/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);
constexpr int kBarCells = 30;

}  // namespace

Progress::Progress(bool quiet, std::optional<std::int64_t> total)
    : shown_(!quiet && isatty(STDERR_FILENO) != 0), total_(total), started_(Clock::now()) {}

Progress::~Progress() {
  if (shown_) {
    std::fputs("\r\033[K", stderr);
  }
}

void Progress::update(std::int64_t done) {
  const auto now = Clock::now();
  if (!shown_ || now - drawn_ < kRedrawEvery) {
    return;
  }
  drawn_ = now;
  const double seconds = std::chrono::duration<double>(now - started_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
  if (!total_) {
    std::fprintf(stderr, "\r%lld frames, %.0f a second\033[K", static_cast<long long>(done), rate);
    return;
  }
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(*total_));
  std::string bar(kBarCells, '.');
  std::fill_n(bar.begin(), static_cast<std::size_t>(share * kBarCells), '#');
  std::fprintf(stderr, "\r[%s] %3.0f %%  %lld/%lld frames, %.0f a second\033[K", bar.c_str(),
               share * 100.0, static_cast<long long>(done), static_cast<long long>(*total_), rate);
}

}  // namespace mien::app
