// Finds columns by name and parses cells.
#include "apps/animation/csv_cells.h"

#include <algorithm>

#include "apps/animation/clip.h"
#include "apps/animation/numbers.h"
#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {

namespace {

// Compares without case.
bool before(std::string_view a, std::string_view b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return formats::to_lower(x) < formats::to_lower(y);
  });
}

}  // namespace

bool CsvHeader::read(CsvTable& table, Fault& fault) {
  if (!table.next_row(fault)) {
    return !fault.what.empty() ? false : fail(fault, 1, 1, "empty file");
  }
  columns_ = table.size();
  for (std::size_t i = 0; i < columns_; ++i) {
    const std::string_view cell = trimmed(table.cell(i));
    if (!cell.empty()) {
      sorted_.push_back({static_cast<std::uint32_t>(names_.size()), static_cast<std::uint32_t>(i)});
      names_.append(cell).append("\n");
    }
  }
  // Among equal names the first column comes first, so that the fault refers to the second.
  std::stable_sort(sorted_.begin(), sorted_.end(),
                   [this](const Name& a, const Name& b) { return before(text(a), text(b)); });
  const auto twice = std::adjacent_find(
      sorted_.begin(), sorted_.end(),
      [this](const Name& a, const Name& b) { return formats::same_name(text(a), text(b)); });
  return twice == sorted_.end() ||
         table.fail_at(twice[1].column, "duplicate column " + quoted(text(*twice)), fault);
}

std::string_view CsvHeader::text(const Name& name) const {
  const std::string_view rest = std::string_view(names_).substr(name.begin);
  return rest.substr(0, rest.find('\n'));
}

Column CsvHeader::find(std::string_view name) const {
  const auto found =
      std::lower_bound(sorted_.begin(), sorted_.end(), name,
                       [this](const Name& a, std::string_view b) { return before(text(a), b); });
  return found != sorted_.end() && formats::same_name(text(*found), name) ? Column(found->column)
                                                                          : Column();
}

std::string_view CsvHeader::name(std::size_t column) const {
  const auto found = std::find_if(sorted_.begin(), sorted_.end(),
                                  [column](const Name& name) { return name.column == column; });
  return found != sorted_.end() ? text(*found) : std::string_view();
}

bool check_width(const CsvTable& table, const CsvHeader& header, Fault& fault) {
  return table.size() == header.size() ||
         table.fail_at(table.size() - 1,
                       "wrong number of cells (got " + std::to_string(table.size()) +
                           ", expected " + std::to_string(header.size()) + ")",
                       fault);
}

bool read_cell(CsvTable& table, const CsvHeader& header, Column column,
               std::optional<double>& value, Fault& fault) {
  value.reset();
  if (!column || *column >= table.size() || trimmed(table.cell(*column)).empty()) {
    return true;
  }
  double number = 0.0;
  if (!table.number(*column, number)) {
    return table.fail_at(
        *column,
        std::string(header.name(*column)) + ": " + quoted(table.cell(*column)) + " is not a number",
        fault);
  }
  value = number;
  return true;
}

bool read_fraction(CsvTable& table, const CsvHeader& header, Column column, double& value,
                   Fault& fault) {
  std::optional<double> number;
  if (!read_cell(table, header, column, number, fault)) {
    return false;
  }
  if (number && (*number < 0.0 || *number > 1.0)) {
    return table.fail_at(
        *column,
        std::string(header.name(*column)) + ": " + quoted(table.cell(*column)) + " is not in 0..1",
        fault);
  }
  value = number.value_or(formats::kNoNumber);
  return true;
}

bool read_clamped(CsvTable& table, const CsvHeader& header, Column column, double& value,
                  std::int64_t& out_of_range, Fault& fault) {
  std::optional<double> number;
  if (!read_cell(table, header, column, number, fault)) {
    return false;
  }
  value = number ? into_range(*number, out_of_range) : formats::kNoNumber;
  return true;
}

double into_range(double value, std::int64_t& out_of_range) {
  const double inside = std::clamp(value, 0.0, 1.0);
  out_of_range += inside != value ? 1 : 0;
  return inside;
}

}  // namespace mien::animation
