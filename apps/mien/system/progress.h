// A progress line on stderr, drawn only on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace mien::app {

class Progress {
 public:
  // `unit`: what is counted, in the plural; static.
  Progress(bool quiet, std::optional<std::int64_t> total, const char* unit = "frames");
  ~Progress();
  void update(std::int64_t done) { update(done, done); }
  // Where the speed is that of something else than what is counted.
  void update(std::int64_t done, std::int64_t frames);

 private:
  bool shown_;
  std::optional<std::int64_t> total_;
  const char* unit_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace mien::app
