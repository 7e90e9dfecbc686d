// Rows of numbers as text that reads back to the same float, whatever the locale.
#pragma once

#include <charconv>
#include <string>

namespace mien::app {

class CsvRow {
 public:
  template <class Number>
  void number(Number value) {
    char digits[64];
    const auto end = std::to_chars(digits, digits + sizeof digits, value);
    text({digits, static_cast<std::size_t>(end.ptr - digits)});
  }
  void text(const std::string& value) {
    separate();
    line_ += value;
  }
  void empty() { separate(); }
  std::string finished() const { return line_ + "\n"; }

 private:
  void separate() {
    line_ += begun_ ? "," : "";
    begun_ = true;
  }

  std::string line_;
  bool begun_ = false;
};

}  // namespace mien::app
