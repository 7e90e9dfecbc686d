// One failure of the program: what to print on stderr, and the exit code.
#pragma once

#include <stdexcept>
#include <string>

#include "apps/mien/system/exit_codes.h"

namespace mien::app {

class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace mien::app
