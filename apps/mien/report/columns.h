// Numbers of a report: columns of whole steps, each value less the one before, which a page reads
// without parsing. docs/cli.md describes them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace mien::app {

class Columns {
 public:
  // Values in steps of `unit`, 16 bits each: those beyond are brought to the nearest, those that
  // are no number stay none.
  void add(const std::string& name, double unit, const std::vector<double>& values);

  // Times, whatever they are, 32 bits each. Go before all others.
  void add_times(const std::string& name, double unit_ms, const std::vector<double>& times_ms);

  // [{"name":..,"unit":..,"bytes":2|4,"count":..}], in their order.
  [[nodiscard]] const nlohmann::ordered_json& list() const { return list_; }

  // All of them, little-endian, one behind the other. Not packed: so a page has them at once.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void note(const std::string& name, double unit, int bytes, std::size_t count);

  nlohmann::ordered_json list_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

// What stands for no number.
inline constexpr std::int16_t kNoStep = INT16_MIN;

// In whole steps of `unit`.
[[nodiscard]] std::int16_t steps(double value, double unit);

// The column in little-endian bytes, each value less the one before.
[[nodiscard]] std::string differences_of(const std::vector<std::int16_t>& column);

}  // namespace mien::app
