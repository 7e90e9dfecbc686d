// Runs another program (ffmpeg or ffprobe) connected by a pipe.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/system/child_process.h"

namespace mien::app {

class Subprocess {
 public:
  using Pipe = ChildProcess::Pipe;

  // Maximum inactivity of a child that reads or writes files.
  static constexpr std::chrono::seconds kTimeout{60};
  // Maximum time of a child after the end of its input: it may move a large file.
  static constexpr std::chrono::minutes kOutputTimeout{30};
  static constexpr std::chrono::milliseconds kNoTimeout{-1};

  // Starts arguments[0], found on PATH. kFromChild connects the child's stdout, kToChild its stdin;
  // stderr is always collected. Throws Failure(kExitNoFfmpeg) if the program does not exist. The
  // child is killed if `read` or `write` waits for it longer than `timeout`.
  Subprocess(const std::vector<std::string>& arguments, Pipe pipe,
             std::chrono::milliseconds timeout = kNoTimeout);
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  // Reads until `bytes` is full or the child closes its end. Returns the number of bytes read.
  std::size_t read(std::span<std::byte> bytes);
  std::string read_all();

  // Returns false if the child has closed its end.
  bool write(std::span<const std::byte> bytes);

  // Kills the child, so that a read in another thread returns. Must not be called after `finish`.
  void interrupt();

  // Closes the pipe and waits. Returns the exit status, or 128 + signal if the child was killed.
  // Kills a child that does not end.
  int finish();

  // Returns and clears the text that the child has written to stderr.
  std::string take_errors();

 private:
  void kill_after_timeout(std::chrono::milliseconds after);

  const std::string name_;
  const std::chrono::milliseconds timeout_;
  const std::chrono::milliseconds final_timeout_;  // after the pipe is closed
  const std::unique_ptr<ChildProcess> child_;
  std::string errors_;
};

}  // namespace mien::app
