// Tables as text (RFC 4180, cells of one line), read row by row, knowing where they are. CR LF and
// empty lines at the end are what spreadsheets make, and no fault; nor are semicolons or tabs
// between cells, with commas within numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "formats/animation/fault.h"

namespace mien::formats {

// Where the cells of a row begin, counted in bytes: 4 bytes a cell, since a row may be all of a
// file. A deque grows without a copy of what it has.
using CellStarts = std::deque<std::uint32_t>;

class CsvTable {
 public:
  // The first line tells what separates cells: the most frequent of comma, semicolon, and tab.
  explicit CsvTable(std::string_view text);

  // False at the end, and where a quotation mark is not closed: then `fault` says so.
  [[nodiscard]] bool next_row(Fault& fault);

  [[nodiscard]] std::size_t size() const { return starts_.size(); }
  // Without quotation marks. Valid until the next call of any function.
  [[nodiscard]] std::string_view cell(std::size_t i);
  // False, and `value` as it was, where the cell is not a finite number.
  [[nodiscard]] bool number(std::size_t i, double& value);
  [[nodiscard]] std::size_t line() const { return line_; }

  // Of a cell of this row, or of the row itself where it has no such cell.
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

}  // namespace mien::formats
