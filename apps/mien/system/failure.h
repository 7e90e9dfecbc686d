// An exception with a message for standard error and an exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/mien/system/exit_codes.h"

namespace mien::app {

class Failure : public std::runtime_error {
 public:
  // `details` are printed on lines of their own.
  Failure(ExitCode code, const std::string& message, std::vector<std::string> details = {})
      : std::runtime_error(message), code_(code), details_(std::move(details)) {}
  ExitCode code() const { return code_; }
  const std::vector<std::string>& details() const { return details_; }

 private:
  ExitCode code_;
  std::vector<std::string> details_;
};

}  // namespace mien::app
