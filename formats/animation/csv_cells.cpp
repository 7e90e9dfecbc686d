#include "formats/animation/csv_cells.h"

#include <algorithm>

#include "formats/animation/clip.h"
#include "formats/animation/numbers.h"
#include "formats/animation/vocabulary.h"

namespace mien::formats {

bool CsvHeader::read(CsvTable& table, Fault& fault) {
  if (!table.next_row(fault)) {
    return !fault.what.empty() ? false : fail(fault, 1, 1, "is empty");
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::string cell(trimmed(table.cell(i)));
    if (!cell.empty() && find(cell)) {
      return table.fail_at(i, "column " + quoted(cell) + " appears twice", fault);
    }
    names_.push_back(cell);
  }
  return true;
}

Column CsvHeader::find(std::string_view name) const {
  const auto found = std::find_if(names_.begin(), names_.end(), [&](const std::string& candidate) {
    return same_name(candidate, name);
  });
  return found == names_.end() ? Column() : Column(found - names_.begin());
}

bool check_width(const CsvTable& table, const CsvHeader& header, Fault& fault) {
  return table.size() == header.size() ||
         table.fail_at(table.size() - 1,
                       "the row has " + std::to_string(table.size()) + " cells, the header " +
                           std::to_string(header.size()),
                       fault);
}

bool read_cell(const CsvTable& table, const CsvHeader& header, Column column,
               std::optional<double>& value, Fault& fault) {
  value.reset();
  if (!column || *column >= table.size() || trimmed(table.cell(*column)).empty()) {
    return true;
  }
  double number = 0.0;
  if (!parse_number(table.cell(*column), number)) {
    return table.fail_at(
        *column, header.name(*column) + ": " + quoted(table.cell(*column)) + " is not a number",
        fault);
  }
  value = number;
  return true;
}

bool read_share(const CsvTable& table, const CsvHeader& header, Column column, double& value,
                Fault& fault) {
  std::optional<double> number;
  if (!read_cell(table, header, column, number, fault)) {
    return false;
  }
  if (number && (*number < 0.0 || *number > 1.0)) {
    return table.fail_at(
        *column, header.name(*column) + ": " + quoted(table.cell(*column)) + " is not in 0..1",
        fault);
  }
  value = number.value_or(kNoNumber);
  return true;
}

bool read_clamped(const CsvTable& table, const CsvHeader& header, Column column, double& value,
                  std::int64_t& out_of_range, Fault& fault) {
  std::optional<double> number;
  if (!read_cell(table, header, column, number, fault)) {
    return false;
  }
  value = number ? into_range(*number, out_of_range) : kNoNumber;
  return true;
}

double into_range(double value, std::int64_t& out_of_range) {
  const double inside = std::clamp(value, 0.0, 1.0);
  out_of_range += inside != value ? 1 : 0;
  return inside;
}

}  // namespace mien::formats
