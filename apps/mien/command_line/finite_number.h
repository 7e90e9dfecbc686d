// A validator for real numbers that rejects NaN and infinity, which CLI11 accepts.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace mien::app {

// Adds a check for finite values to `limits`. Every option with a real number needs it: NaN passes
// all limits of CLI11, because it is neither below nor above one.
inline CLI::Validator finite(const CLI::Validator& limits) {
  CLI::Validator result = limits;
  result.operation([limits](std::string& text) {
    double value = 0.0;
    if (CLI::detail::lexical_cast(text, value) && !std::isfinite(value)) {
      return "'" + text + "' is not a finite number";
    }
    return limits(text);
  });
  return result;
}

}  // namespace mien::app
