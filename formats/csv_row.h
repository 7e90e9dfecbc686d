// One line of a CSV file, whatever the locale: floats take the fewest digits that read back the
// same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace mien::formats {

class CsvRow {
 public:
  static constexpr std::size_t kMaxNumberBytes = 25;  // one cell of a number with its comma

  // Writes into `buffer`, the caller's, which must outlive the row.
  explicit CsvRow(std::span<char> buffer) : buffer_(buffer) {}

  void add(std::int64_t value);
  void add(float value);             // not finite: an empty cell
  void add(double value);            // not finite: an empty cell
  void add(std::string_view value);  // quoted where RFC 4180 asks for it
  void add_empty();

  // The line with its '\n', or nothing at all where the buffer was too small. Starts a new row.
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

}  // namespace mien::formats
