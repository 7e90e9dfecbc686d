// Formats cells and quotes text.
#include "apps/animation/csv_row.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace mien::animation {

void CsvRow::put(std::string_view text) {
  if (text.size() > buffer_.size() - used_) {
    overflow_ = true;
  }
  if (overflow_ || text.empty()) {
    return;
  }
  std::memcpy(buffer_.data() + used_, text.data(), text.size());
  used_ += text.size();
}

void CsvRow::begin_cell() {
  if (has_cell_) {
    put(",");
  }
  has_cell_ = true;
}

template <typename Number>
void CsvRow::add_number(Number value) {
  begin_cell();
  std::array<char, kMaxNumberBytes> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  put({digits.data(), static_cast<std::size_t>(end - digits.data())});
}

void CsvRow::add(std::int64_t value) { add_number(value); }

void CsvRow::add(float value) { std::isfinite(value) ? add_number(value) : add_empty(); }

void CsvRow::add(double value) { std::isfinite(value) ? add_number(value) : add_empty(); }

void CsvRow::add(std::string_view value) {
  begin_cell();
  if (value.find_first_of(",\"\r\n") == std::string_view::npos) {
    put(value);
    return;
  }
  put("\"");
  for (std::size_t quote = value.find('"'); quote != std::string_view::npos;
       quote = value.find('"')) {
    put(value.substr(0, quote + 1));
    put("\"");
    value.remove_prefix(quote + 1);
  }
  put(value);
  put("\"");
}

void CsvRow::add_empty() { begin_cell(); }

std::string_view CsvRow::finish() {
  put("\n");
  const std::string_view line(buffer_.data(), overflow_ ? 0 : used_);
  used_ = 0;
  has_cell_ = false;
  overflow_ = false;
  return line;
}

}  // namespace mien::animation
