// A running program and the pipes to it, as the operating system has them: posix/ and win32/ have
// one each.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mien::app {

class ChildProcess {
 public:
  enum class Pipe { kToChild, kFromChild };

  // Starts arguments[0], found on PATH, with only these pipes of ours. Throws
  // Failure(kExitNoFfmpeg) when the program is not there.
  static std::unique_ptr<ChildProcess> start(const std::vector<std::string>& arguments, Pipe pipe);

  // Whoever was not waited for is ended.
  virtual ~ChildProcess() = default;

  // One transfer of as many bytes as the pipe has, or takes, and how many that were; 0: the child
  // closed its end; none: neither here nor on stderr anything happened for so long, below 0 being
  // for ever. What the child says on stderr is taken meanwhile: blocked on that, it would never get
  // on with the other.
  virtual std::optional<std::size_t> read(std::span<std::byte> bytes,
                                          std::chrono::milliseconds patience) = 0;
  virtual std::optional<std::size_t> write(std::span<const std::byte> bytes,
                                           std::chrono::milliseconds patience) = 0;
  virtual void close_pipe() = 0;

  // Ends the child; also from another thread, until `wait` was called.
  virtual void kill() = 0;

  // Returns the exit status, 128 + signal when killed; none: it still runs after so long, below 0
  // being for ever. What else holds its stderr open is not waited for.
  virtual std::optional<int> wait(std::chrono::milliseconds patience) = 0;

  // What the child has said on stderr so far and nobody has taken.
  virtual std::string take_errors() = 0;
};

}  // namespace mien::app
