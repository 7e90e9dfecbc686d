// Names of morph targets, expressions and bones in a spelling that can be compared.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "formats/vocabulary/vocabulary.h"

namespace mien::formats {

// What follows the last dot, colon or bar.
inline std::string_view without_path(std::string_view name) {
  const std::size_t mark = name.find_last_of(".:|");
  return mark == std::string_view::npos ? name : name.substr(mark + 1);
}

// The letters and digits of a name in lower case, with sides spelled out (_L is left), and without
// what precedes a dot, colon or bar.
class PlainName {
 public:
  explicit PlainName(std::string_view name) {
    name = without_path(name);
    std::string_view side;
    if (name.size() > 1 && name[name.size() - 2] == '_') {
      const char last = to_lower(name.back());
      side = last == 'l' ? "left" : last == 'r' ? "right" : "";
    }
    append(side.empty() ? name : name.substr(0, name.size() - 1));
    append(side);
  }
  // Empty if it is longer than any name that programs look for.
  [[nodiscard]] std::string_view text() const {
    return size_ <= text_.size() ? std::string_view(text_.data(), size_) : std::string_view();
  }

 private:
  void append(std::string_view name) {
    for (const char letter : name) {
      const char lower = to_lower(letter);
      if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) {
        if (size_ < text_.size()) {
          text_[size_] = lower;
        }
        ++size_;
      }
    }
  }
  std::array<char, 32> text_ = {};
  std::size_t size_ = 0;
};

}  // namespace mien::formats
