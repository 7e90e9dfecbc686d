// Tables as text (RFC 4180, cells of one line), read row by row with positions. Accepts CR LF and
// empty lines at the end, as spreadsheets write them, and semicolons or tabs as separators with
// decimal commas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "apps/animation/fault.h"

namespace mien::animation {

// Byte offsets of the cells of a row: 4 bytes each, because a row may be the whole file. A deque
// grows without copying.
using CellStarts = std::deque<std::uint32_t>;

class CsvTable {
 public:
  // The separator is the most frequent of comma, semicolon and tab in the first line.
  explicit CsvTable(std::string_view text);

  // Returns false at the end, and with a fault if a quotation mark is unterminated.
  [[nodiscard]] bool next_row(Fault& fault);

  [[nodiscard]] std::size_t size() const { return starts_.size(); }
  // Without quotation marks. Valid until the next call of any function.
  [[nodiscard]] std::string_view cell(std::size_t i);
  // Returns false and leaves `value` unchanged if the cell is not a finite number.
  [[nodiscard]] bool number(std::size_t i, double& value);
  [[nodiscard]] std::size_t line() const { return line_; }

  // Reports an error at a cell of this row, or at the row if the cell does not exist.
  [[nodiscard]] bool fail_at(std::size_t i, const std::string& what, Fault& fault) const;

 private:
  [[nodiscard]] bool split(Fault& fault);
  [[nodiscard]] std::string_view raw(std::size_t i) const;

  std::string_view rest_;
  std::string_view row_;
  char separator_;
  std::size_t line_ = 0;
  CellStarts starts_;
  std::string unquoted_;
};

}  // namespace mien::animation
