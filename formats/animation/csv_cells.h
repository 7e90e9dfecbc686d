// What readers of tables share: columns by name, numbers with their place in a fault.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/csv_table.h"

namespace mien::formats {

using Column = std::optional<std::size_t>;

// The header of a table: which column has which name, whatever the case. Columns are sorted by
// their names, so that any number of them is read in nearly linear time.
class CsvHeader {
 public:
  // Reads the first row. False where there is none, or a name stands there twice.
  [[nodiscard]] bool read(CsvTable& table, Fault& fault);

  [[nodiscard]] std::size_t size() const { return columns_; }
  [[nodiscard]] Column find(std::string_view name) const;
  [[nodiscard]] std::string_view name(std::size_t column) const;

 private:
  struct Name {
    std::uint32_t begin, column;  // `begin` in names_
  };

  [[nodiscard]] std::string_view text(const Name& name) const;

  std::string names_;         // each with '\n' behind it; no name has one inside
  std::vector<Name> sorted_;  // those that are not empty
  std::size_t columns_ = 0;
};

// Whether the row has as many cells as the header.
[[nodiscard]] bool check_width(const CsvTable& table, const CsvHeader& header, Fault& fault);

// The number of a cell; nothing for an empty cell and for a column that is not there. False where
// the cell is no number.
[[nodiscard]] bool read_cell(CsvTable& table, const CsvHeader& header, Column column,
                             std::optional<double>& value, Fault& fault);

// The same of what has to lie in 0..1; kNoNumber where there is nothing.
[[nodiscard]] bool read_share(CsvTable& table, const CsvHeader& header, Column column,
                              double& value, Fault& fault);

// The same of what files of others may exaggerate: brought into 0..1, and counted.
[[nodiscard]] bool read_clamped(CsvTable& table, const CsvHeader& header, Column column,
                                double& value, std::int64_t& out_of_range, Fault& fault);

// Into 0..1, and counted where it was not there.
[[nodiscard]] double into_range(double value, std::int64_t& out_of_range);

}  // namespace mien::formats
