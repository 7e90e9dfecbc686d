// Encodes columns as differences of integers.
#include "apps/mien/report/columns.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace mien::app {
namespace {

template <typename Step>
std::string bytes_of_differences(const std::vector<Step>& column) {
  using Bits = std::make_unsigned_t<Step>;
  std::string bytes;
  bytes.reserve(column.size() * sizeof(Step));
  Bits before = 0;
  for (const Step step : column) {
    const auto now = static_cast<Bits>(step);
    const auto difference = static_cast<Bits>(now - before);
    for (std::size_t byte = 0; byte < sizeof(Step); ++byte) {
      bytes.push_back(static_cast<char>(difference >> (8 * byte) & 0xFF));
    }
    before = now;
  }
  return bytes;
}

}  // namespace

std::int16_t steps(double value, double unit) {
  if (!std::isfinite(value)) {
    return kNoStep;
  }
  const double whole = std::round(value / unit);
  return static_cast<std::int16_t>(std::clamp(whole, INT16_MIN + 1.0, INT16_MAX + 0.0));
}

std::string differences_of(const std::vector<std::int16_t>& column) {
  return bytes_of_differences(column);
}

void Columns::note(const std::string& name, double unit, int bytes, std::size_t count) {
  list_.push_back({{"name", name}, {"unit", unit}, {"bytes", bytes}, {"count", count}});
}

void Columns::add(const std::string& name, double unit, const std::vector<double>& values) {
  note(name, unit, 2, values.size());
  std::vector<std::int16_t> column(values.size());
  std::transform(values.begin(), values.end(), column.begin(),
                 [unit](double value) { return steps(value, unit); });
  bytes_ += differences_of(column);
}

void Columns::add_times(const std::string& name, double unit_ms,
                        const std::vector<double>& times_ms) {
  note(name, unit_ms, 4, times_ms.size());
  std::vector<std::int32_t> column(times_ms.size());
  std::transform(times_ms.begin(), times_ms.end(), column.begin(), [unit_ms](double time_ms) {
    return static_cast<std::int32_t>(
        std::clamp(std::round(time_ms / unit_ms), INT32_MIN + 0.0, INT32_MAX + 0.0));
  });
  bytes_ += bytes_of_differences(column);
}

}  // namespace mien::app
