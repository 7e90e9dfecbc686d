// A running program and its pipes, as the operating system provides them. posix/ and win32/ have
// one implementation each.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/system/failure.h"

namespace mien::app {

class ChildProcess {
 public:
  enum class Pipe { kToChild, kFromChild };

  // Starts arguments[0], found on PATH; the child inherits only these pipes. Throws
  // Failure(kExitNoFfmpeg) if the program does not exist.
  static std::unique_ptr<ChildProcess> start(const std::vector<std::string>& arguments, Pipe pipe);

  // Kills the child unless `wait` has returned its status.
  virtual ~ChildProcess() = default;

  // One transfer of as many bytes as the pipe holds or accepts. Returns their number, 0 if the
  // child closed its end, or nothing if neither this pipe nor stderr had activity within the
  // timeout (negative: none). The functions read stderr meanwhile, because a child that blocks on
  // stderr never serves the other pipe.
  virtual std::optional<std::size_t> read(std::span<std::byte> bytes,
                                          std::chrono::milliseconds timeout) = 0;
  virtual std::optional<std::size_t> write(std::span<const std::byte> bytes,
                                           std::chrono::milliseconds timeout) = 0;
  virtual void close_pipe() = 0;

  // Kills the child. Other threads may call it until `wait` is called.
  virtual void kill() = 0;

  // Returns the exit status, 128 + signal if killed, or nothing if the child still runs after the
  // timeout (negative: none). Does not wait for other processes that hold its stderr open.
  virtual std::optional<int> wait(std::chrono::milliseconds timeout) = 0;

  // Returns and clears the text that the child has written to stderr.
  virtual std::string take_errors() = 0;
};

// The error of a program that does not start, with advice.
[[nodiscard]] Failure cannot_run(const std::string& program, const std::string& reason);

}  // namespace mien::app
