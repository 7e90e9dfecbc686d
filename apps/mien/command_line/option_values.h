// Checks of option values. Their errors name the value and the expected ones; those of CLI11 print
// internal values, and its limits let NaN pass, which is neither below nor above one.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace mien::app {

inline std::string invalid_value(const std::string& text, const std::string& expected) {
  return "invalid value (got '" + text + "', expected " + expected + ")";
}

// A number for which `allowed` is true.
template <typename Number>
CLI::Validator number(const std::string& expected, const std::function<bool(Number)>& allowed) {
  const auto check = [expected, allowed](std::string& text) {
    Number value{};
    const bool valid = CLI::detail::lexical_cast(text, value) &&
                       std::isfinite(static_cast<double>(value)) && allowed(value);
    return valid ? std::string() : invalid_value(text, expected);
  };
  return {check, ""};
}

inline CLI::Validator number_from(double min, double max) {
  std::ostringstream expected;
  expected.precision(10);
  expected << "a number from " << min << " to " << max;
  return number<double>(expected.str(),
                        [min, max](double value) { return value >= min && value <= max; });
}

inline CLI::Validator positive_number() {
  return number<double>("a number above 0", [](double value) { return value > 0.0; });
}

inline CLI::Validator non_negative_number() {
  return number<double>("a number from 0", [](double value) { return value >= 0.0; });
}

inline CLI::Validator integer_from(int min, int max) {
  return number<int>("an integer from " + std::to_string(min) + " to " + std::to_string(max),
                     [min, max](int value) { return value >= min && value <= max; });
}

// Accepts the given words only, and replaces each with its value.
template <typename Value>
CLI::Validator one_of(const std::vector<std::pair<std::string, Value>>& values) {
  std::string expected;
  for (std::size_t i = 0; i < values.size(); ++i) {
    expected += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + values[i].first;
  }
  const CLI::Validator transform = CLI::CheckedTransformer(values);
  const auto check = [values, expected, transform](std::string& text) {
    for (const auto& [word, value] : values) {
      if (text == word) {
        return transform(text);
      }
    }
    return invalid_value(text, expected);
  };
  return {check, ""};
}

}  // namespace mien::app
