#include "apps/mien/compare/curves_file.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>

#include "apps/mien/failure.h"

namespace mien::app {
namespace {

constexpr double kNotDriven = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kAngleNames[3] = {"pitch_rad", "yaw_rad", "roll_rad"};

// The text line by line and cell by cell, knowing where it is for the sake of messages.
class Table {
 public:
  Table(std::string_view text, const std::string& name);

  bool next_row();  // false at the end
  [[nodiscard]] const std::vector<std::string>& cells() const { return cells_; }
  // Nothing for an empty cell; fails on what is no finite number.
  [[nodiscard]] std::optional<double> number(std::size_t column) const;
  [[nodiscard]] std::optional<std::size_t> column(const std::string& name) const;

  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail(std::size_t column, const std::string& message) const;

 private:
  void split(std::string_view line);

  std::string_view rest_;
  const std::string& name_;
  std::size_t row_ = 0;  // counted from 1, the header
  std::vector<std::string> header_;
  std::vector<std::string> cells_;
};

Table::Table(std::string_view text, const std::string& name) : rest_(text), name_(name) {
  if (rest_.starts_with("\xEF\xBB\xBF")) {  // spreadsheets begin UTF-8 with a byte order mark
    rest_.remove_prefix(3);
  }
  if (!next_row()) {
    throw Failure(kExitNoInput, name_ + ": is empty");
  }
  header_ = cells_;
}

void Table::fail(const std::string& message) const {
  throw Failure(kExitNoInput, name_ + ": row " + std::to_string(row_) + ": " + message);
}

void Table::fail(std::size_t column, const std::string& message) const {
  fail("column " + header_[column] + ": " + message);
}

bool Table::next_row() {
  if (rest_.find_first_not_of("\r\n") == std::string_view::npos) {
    return false;  // empty lines at the end are no rows
  }
  const std::size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  ++row_;
  split(line);
  if (!header_.empty() && cells_.size() != header_.size()) {
    fail("has " + std::to_string(cells_.size()) + " cells, the header has " +
         std::to_string(header_.size()));
  }
  return true;
}

// RFC 4180, with cells of one line only.
void Table::split(std::string_view line) {
  cells_.assign(1, {});
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells_.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells_.emplace_back();
    } else {
      cells_.back() += c;
    }
  }
  if (quoted) {
    fail("a quotation mark is not closed");
  }
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// A cell in a message.
std::string in_quotes(std::string_view text) {
  return std::string("'").append(trimmed(text).substr(0, 40)).append("'");
}

std::optional<double> Table::number(std::size_t column) const {
  const std::string_view text = trimmed(cells_[column]);
  if (text.empty()) {
    return std::nullopt;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    fail(column, in_quotes(text) + " is not a number");
  }
  return value;
}

std::optional<std::size_t> Table::column(const std::string& name) const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (trimmed(header_[i]) != name) {
      continue;
    }
    if (found) {
      fail("column " + name + ": appears twice");
    }
    found = i;
  }
  return found;
}

// Where in a row to find what.
struct Columns {
  explicit Columns(const Table& table);

  std::size_t time = 0;
  std::array<std::optional<std::size_t>, 3> angles;
  std::array<std::optional<std::size_t>, MIEN_CONTROL_COUNT> controls;
};

Columns::Columns(const Table& table) {
  const auto time_column = table.column("t_ms");
  if (!time_column) {
    table.fail("has no column t_ms");
  }
  time = *time_column;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    angles[i] = table.column(kAngleNames[i]);
  }
  bool any = false;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    controls[i] = table.column(mien_control_name(static_cast<std::int32_t>(i)));
    any = any || controls[i];
  }
  if (!any) {
    table.fail("has no column of a control (eyeBlinkLeft ... tongueOut)");
  }
}

double read_time(const Table& table, const Columns& columns, const Curves& before) {
  const auto time = table.number(columns.time);
  if (!time) {
    table.fail(columns.time, "is empty");
  }
  if (!before.empty() && *time < before.back().t_ms) {
    table.fail(columns.time, "goes back in time");
  }
  return *time;
}

std::optional<HeadAngles> read_head(const Table& table, const Columns& columns) {
  std::array<double, 3> angles{};
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const auto angle = columns.angles[i] ? table.number(*columns.angles[i]) : std::nullopt;
    if (!angle) {
      return std::nullopt;
    }
    if (std::abs(*angle) > 2.0 * std::numbers::pi) {
      table.fail(*columns.angles[i], "more than a full turn; angles are in radians");
    }
    angles[i] = *angle;
  }
  return HeadAngles{angles[0], angles[1], angles[2]};
}

double read_control(const Table& table, std::optional<std::size_t> column) {
  const auto value = column ? table.number(*column) : std::nullopt;
  if (value && (*value < 0.0 || *value > 1.0)) {
    table.fail(*column, in_quotes(table.cells()[*column]) + " is not in 0..1");
  }
  return value.value_or(kNotDriven);
}

}  // namespace

Curves parse_curves(std::string_view text, const std::string& name) {
  Table table(text, name);
  const Columns columns(table);
  Curves curves;
  while (table.next_row()) {
    CurvesFrame frame;
    frame.t_ms = read_time(table, columns, curves);
    frame.head = read_head(table, columns);
    for (std::size_t i = 0; i < frame.controls.size(); ++i) {
      frame.controls[i] = read_control(table, columns.controls[i]);
    }
    curves.push_back(frame);
  }
  if (curves.empty()) {
    throw Failure(kExitNoInput, name + ": has no frames");
  }
  return curves;
}

Curves read_curves(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Failure(kExitNoInput, path + ": is a directory");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Failure(
        kExitNoInput,
        path + ": " + (std::filesystem::exists(path, ignored) ? "cannot be read" : "no such file"));
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return parse_curves(text, path);
}

}  // namespace mien::app
