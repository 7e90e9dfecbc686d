// A progress line on stderr, drawn only on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace mien::app {

class Progress {
 public:
  Progress(bool quiet, std::optional<std::int64_t> total);
  ~Progress();
  void update(std::int64_t done);

 private:
  bool shown_;
  std::optional<std::int64_t> total_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace mien::app
