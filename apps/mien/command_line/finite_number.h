// What CLI11 does not check of real numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace mien::app {

// The limits, for all options that are real numbers: NaN is neither below a limit nor above one,
// and so within all of CLI11's.
inline CLI::Validator finite(const CLI::Validator& limits) {
  CLI::Validator made = limits;
  made.operation([limits](std::string& text) {
    double value = 0.0;
    if (CLI::detail::lexical_cast(text, value) && !std::isfinite(value)) {
      return "'" + text + "' is no number that could be meant";
    }
    return limits(text);
  });
  return made;
}

}  // namespace mien::app
