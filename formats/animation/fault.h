// What is wrong with a file that was to be read, and where.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace mien::formats {

struct Fault {
  std::size_t line = 0;    // from 1; 0: of a binary file
  std::size_t column = 0;  // bytes from 1; of a binary file the byte from 0
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

// Fills in the fault and says no, for `return fail(...)`.
[[nodiscard]] inline bool fail(Fault& fault, std::size_t line, std::size_t column,
                               std::string what) {
  fault = {line, column, std::move(what)};
  return false;
}

}  // namespace mien::formats
