// Writes one line of a CSV file, independent of the locale, with the shortest decimal digits that
// read back as the same number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace mien::animation {

class CsvRow {
 public:
  static constexpr std::size_t kMaxNumberBytes = 25;  // a number with its comma

  // Writes to `buffer`, which must outlive the row.
  explicit CsvRow(std::span<char> buffer) : buffer_(buffer) {}

  void add(std::int64_t value);
  void add(float value);             // writes an empty cell unless finite
  void add(double value);            // writes an empty cell unless finite
  void add(std::string_view value);  // quoted if RFC 4180 requires it
  void add_empty();

  // Returns the line with its '\n', or nothing if the buffer is too small. Starts a new row.
  [[nodiscard]] std::string_view finish();

 private:
  template <typename Number>
  void add_number(Number value);
  void begin_cell();
  void put(std::string_view text);

  std::span<char> buffer_;
  std::size_t used_ = 0;
  bool has_cell_ = false;
  bool overflow_ = false;
};

}  // namespace mien::animation
