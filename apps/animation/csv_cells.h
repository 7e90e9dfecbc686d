// Columns by name and numbers with positions, for readers of tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/csv_table.h"

namespace mien::animation {

using Column = std::optional<std::size_t>;

// The header of a table. Names ignore case. Columns are sorted by name, so reading any number of
// them takes nearly linear time.
class CsvHeader {
 public:
  // Reads the first row. Returns false if it is missing or has duplicate names.
  [[nodiscard]] bool read(CsvTable& table, Fault& fault);

  [[nodiscard]] std::size_t size() const { return columns_; }
  [[nodiscard]] Column find(std::string_view name) const;
  [[nodiscard]] std::string_view name(std::size_t column) const;

 private:
  struct Name {
    std::uint32_t begin, column;  // `begin` in names_
  };

  [[nodiscard]] std::string_view text(const Name& name) const;

  std::string names_;         // each followed by '\n', which no name contains
  std::vector<Name> sorted_;  // non-empty names
  std::size_t columns_ = 0;
};

// Whether the row has the same number of cells as the header.
[[nodiscard]] bool check_width(const CsvTable& table, const CsvHeader& header, Fault& fault);

// Reads a number; nothing for an empty cell or a missing column. Returns false if the cell is not a
// number.
[[nodiscard]] bool read_cell(CsvTable& table, const CsvHeader& header, Column column,
                             std::optional<double>& value, Fault& fault);

// The same for numbers in 0..1; kNoNumber for an empty cell or a missing column.
[[nodiscard]] bool read_fraction(CsvTable& table, const CsvHeader& header, Column column,
                                 double& value, Fault& fault);

// The same for files of other programs, which may exceed 0..1: clamps and counts such values.
[[nodiscard]] bool read_clamped(CsvTable& table, const CsvHeader& header, Column column,
                                double& value, std::int64_t& out_of_range, Fault& fault);

// Clamps to 0..1, and counts values outside.
[[nodiscard]] double into_range(double value, std::int64_t& out_of_range);

}  // namespace mien::animation
