// Runs the checks that the options select.
#pragma once

#include <cstdint>
#include <string>

#include "apps/conformance/exit_codes.h"

namespace mien::conformance {

struct Options {
  bool list = false, bench = false, block = false, self_test = false;
  std::string filter = "*";
  std::string tier;  // empty: all
  std::uint64_t seed = 1;
  int repeat = 1;
  std::string json;    // empty: none; "-": standard output
  std::string models;  // empty: the default of `mien`
};

[[nodiscard]] ExitCode run(const Options& options);

}  // namespace mien::conformance
