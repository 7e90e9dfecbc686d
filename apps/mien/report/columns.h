// Numeric columns of a report: differences of integers, which a page reads without parsing.
// docs/cli.md describes them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace mien::app {

class Columns {
 public:
  // Adds values as 16-bit multiples of `unit`. Values out of range are clamped; NaN stays NaN.
  void add(const std::string& name, double unit, const std::vector<double>& values);

  // Adds times of any size as 32-bit integers. Must precede all other columns.
  void add_times(const std::string& name, double unit_ms, const std::vector<double>& times_ms);

  // [{"name":..,"unit":..,"bytes":2|4,"count":..}], in the order of addition.
  [[nodiscard]] const nlohmann::ordered_json& list() const { return list_; }

  // All columns in sequence, little-endian. Not compressed, so that the page can read them at once.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void note(const std::string& name, double unit, int bytes, std::size_t count);

  nlohmann::ordered_json list_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

// Stands for NaN.
inline constexpr std::int16_t kNoStep = INT16_MIN;

// As a multiple of `unit`.
[[nodiscard]] std::int16_t steps(double value, double unit);

// The column as little-endian bytes, each value as the difference to the previous one.
[[nodiscard]] std::string differences_of(const std::vector<std::int16_t>& column);

}  // namespace mien::app
