// Notices calls that no real-time thread may make: the heap, locks, waiting, exceptions, locales,
// files.
#pragma once

#include <string>
#include <vector>

namespace mien::tests {

// From its making to the end of its scope, calls of this process are noted, whichever library makes
// them.
class ForbiddenCalls {
 public:
  ForbiddenCalls();
  ~ForbiddenCalls();
  ForbiddenCalls(const ForbiddenCalls&) = delete;
  ForbiddenCalls& operator=(const ForbiddenCalls&) = delete;

  // Names, each once for every call, the first ones of very many. Ends the noting.
  [[nodiscard]] std::vector<std::string> stop();
};

// From here on a system call, but for the end of the process and writing, ends it with exit status
// 1 and the call's number on standard error. False where the kernel does not offer that.
[[nodiscard]] bool forbid_system_calls();

}  // namespace mien::tests
