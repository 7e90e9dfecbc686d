// Splits tables into rows and cells.
#include "apps/animation/csv_table.h"

#include <algorithm>
#include <limits>

#include "apps/animation/numbers.h"

namespace mien::animation {
namespace {

std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

// Ignores text in quotation marks.
char separator_of(std::string_view line) {
  std::size_t commas = 0, semicolons = 0, tabs = 0;
  bool in_quotes = false;
  for (const char c : line) {
    in_quotes ^= c == '"';
    if (!in_quotes) {
      commas += c == ',' ? 1 : 0;
      semicolons += c == ';' ? 1 : 0;
      tabs += c == '\t' ? 1 : 0;
    }
  }
  return semicolons > std::max(commas, tabs) ? ';' : tabs > commas ? '\t' : ',';
}

}  // namespace

CsvTable::CsvTable(std::string_view text)
    : rest_(text), separator_(separator_of(first_line(text))) {}

bool CsvTable::next_row(Fault& fault) {
  fault = {};
  if (rest_.find_first_not_of("\r\n") == std::string_view::npos) {
    return false;
  }
  row_ = first_line(rest_);
  rest_.remove_prefix(std::min(row_.size() + 1, rest_.size()));
  if (row_.ends_with('\r')) {
    row_.remove_suffix(1);
  }
  ++line_;
  return split(fault);
}

bool CsvTable::split(Fault& fault) {
  if (row_.size() >= std::numeric_limits<std::uint32_t>::max()) {
    return fail(fault, line_, 1, "the line is longer than 4 GB");
  }
  starts_.assign(1, 0);
  bool in_quotes = false;
  std::size_t opened = 0;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (row_[i] == '"') {
      in_quotes = !in_quotes;
      opened = i + 1;
    } else if (row_[i] == separator_ && !in_quotes) {
      starts_.push_back(static_cast<std::uint32_t>(i + 1));
    }
  }
  return !in_quotes || fail(fault, line_, opened, "unterminated quotation mark");
}

std::string_view CsvTable::raw(std::size_t i) const {
  const std::size_t end = i + 1 < starts_.size() ? starts_[i + 1] - 1 : row_.size();
  return row_.substr(starts_[i], end - starts_[i]);
}

std::string_view CsvTable::cell(std::size_t i) {
  const std::string_view text = raw(i);
  if (text.find('"') == std::string_view::npos) {
    return text;
  }
  unquoted_.clear();
  bool in_quotes = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '"') {
      unquoted_ += text[k];
    } else if (in_quotes && k + 1 < text.size() && text[k + 1] == '"') {
      unquoted_ += text[k++];
    } else {
      in_quotes = !in_quotes;
    }
  }
  return unquoted_;
}

bool CsvTable::number(std::size_t i, double& value) {
  const std::string_view text = cell(i);
  if (separator_ == ',' || text.find(',') == std::string_view::npos) {
    return parse_number(text, value);
  }
  std::string with_point(text);
  with_point[text.find(',')] = '.';
  return parse_number(with_point, value);
}

bool CsvTable::fail_at(std::size_t i, const std::string& what, Fault& fault) const {
  return fail(fault, line_, i < starts_.size() ? starts_[i] + 1 : 1, what);
}

}  // namespace mien::animation
