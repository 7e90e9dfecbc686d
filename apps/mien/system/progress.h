// A progress line on standard error, drawn only on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace mien::app {

class Progress {
 public:
  // `unit`: the plural of the counted unit, a static string.
  Progress(bool quiet, std::optional<std::int64_t> total, const char* unit = "frames");
  ~Progress();
  void update(std::int64_t done) { update(done, done); }
  // `frames` determines the displayed speed if `done` counts something else.
  void update(std::int64_t done, std::int64_t frames);

 private:
  bool enabled_;
  std::optional<std::int64_t> total_;
  const char* unit_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace mien::app
