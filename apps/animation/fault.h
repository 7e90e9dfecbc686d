// The reason and position of a failed read.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace mien::animation {

struct Fault {
  std::size_t line = 0;    // from 1; 0: a binary file
  std::size_t column = 0;  // in bytes from 1; in a binary file, the offset from 0
  std::string what;
};

// "line 3, column 14: 'half' is not a number", "byte 12: ..."
[[nodiscard]] inline std::string describe(const Fault& fault) {
  if (fault.line == 0) {
    return "byte " + std::to_string(fault.column) + ": " + fault.what;
  }
  return "line " + std::to_string(fault.line) + ", column " + std::to_string(fault.column) + ": " +
         fault.what;
}

// Sets the fault and returns false, for `return fail(...)`.
[[nodiscard]] inline bool fail(Fault& fault, std::size_t line, std::size_t column,
                               std::string what) {
  fault = {line, column, std::move(what)};
  return false;
}

}  // namespace mien::animation
