// Tables as text (RFC 4180, cells of one line), read row by row, knowing where they are. CR LF and
// empty lines at the end are what spreadsheets make, and no fault.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/fault.h"

namespace mien::formats {

class CsvTable {
 public:
  explicit CsvTable(std::string_view text) : rest_(text) {}

  // False at the end, and where a quotation mark is not closed: then `fault` says so.
  [[nodiscard]] bool next_row(Fault& fault);

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] const std::string& cell(std::size_t i) const { return cells_[i].text; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::size_t column(std::size_t i) const { return cells_[i].column; }

  // Of a cell of this row, or of the row itself where it has no such cell.
  [[nodiscard]] bool fail_at(std::size_t i, const std::string& what, Fault& fault) const;

 private:
  struct Cell {
    std::string text;
    std::size_t column;
  };

  [[nodiscard]] bool split(std::string_view text, Fault& fault);

  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace mien::formats
