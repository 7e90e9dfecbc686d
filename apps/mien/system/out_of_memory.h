// Ends the program when an allocation fails inside functions of libraries that are noexcept, where
// std::bad_alloc would call std::terminate.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <new>

#include "apps/mien/system/exit_codes.h"

namespace mien::app {

// A handler for std::set_new_handler: reports the failure and exits with kExitInternal.
[[noreturn]] inline void end_without_memory() {
  std::fputs("mien: no memory\n", stderr);
  std::_Exit(kExitInternal);
}

// Installs that handler for its lifetime. Use it before outputs exist, because they would remain.
class OutOfMemoryGuard {
 public:
  OutOfMemoryGuard() : previous_(std::set_new_handler(end_without_memory)) {}
  ~OutOfMemoryGuard() { std::set_new_handler(previous_); }
  OutOfMemoryGuard(const OutOfMemoryGuard&) = delete;
  OutOfMemoryGuard& operator=(const OutOfMemoryGuard&) = delete;

 private:
  std::new_handler previous_;
};

}  // namespace mien::app
