// Detects calls that a real-time thread must not make: heap, locks, waiting, exceptions, locales,
// files.
#pragma once

#include <string>
#include <vector>

namespace mien::tests {

// Records forbidden calls of this process, from any library, during its lifetime.
class ForbiddenCalls {
 public:
  ForbiddenCalls();
  ~ForbiddenCalls();
  ForbiddenCalls(const ForbiddenCalls&) = delete;
  ForbiddenCalls& operator=(const ForbiddenCalls&) = delete;

  // Stops recording and returns the name of every call, up to a limit.
  [[nodiscard]] std::vector<std::string> stop();
};

// From now on a system call ends the process with exit status 1 and prints its number to standard
// error, except exit and write. Returns false if the kernel does not support this.
[[nodiscard]] bool forbid_system_calls();

}  // namespace mien::tests
