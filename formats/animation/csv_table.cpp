#include "formats/animation/csv_table.h"

namespace mien::formats {

bool CsvTable::next_row(Fault& fault) {
  fault = {};
  if (rest_.find_first_not_of("\r\n") == std::string_view::npos) {
    return false;
  }
  const std::size_t end = rest_.find('\n');
  std::string_view text = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (text.ends_with('\r')) {
    text.remove_suffix(1);
  }
  ++line_;
  return split(text, fault);
}

bool CsvTable::split(std::string_view text, Fault& fault) {
  cells_.assign(1, {{}, 1});
  bool in_quotes = false;
  std::size_t opened = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && in_quotes && i + 1 < text.size() && text[i + 1] == '"') {
      cells_.back().text += '"';
      ++i;
    } else if (c == '"') {
      in_quotes = !in_quotes;
      opened = i + 1;
    } else if (c == ',' && !in_quotes) {
      cells_.push_back({{}, i + 2});
    } else {
      cells_.back().text += c;
    }
  }
  return !in_quotes || fail(fault, line_, opened, "this quotation mark is not closed");
}

bool CsvTable::fail_at(std::size_t i, const std::string& what, Fault& fault) const {
  return fail(fault, line_, i < cells_.size() ? cells_[i].column : 1, what);
}

}  // namespace mien::formats
