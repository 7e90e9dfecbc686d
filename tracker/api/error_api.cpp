// C API: error details as text.
#include <mien/mien.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "formats/error_detail.h"
#include "kernels/float_mode.h"

namespace {

// Appends text to a buffer, truncated to its capacity, and counts all characters. printf would
// depend on the caller's locale.
class Text {
 public:
  Text(char* text, std::size_t bytes) : text_(text), capacity_(text != nullptr ? bytes : 0) {}

  [[nodiscard]] std::size_t size() const { return size_; }

  void append(char c) {
    if (size_ + 1 < capacity_) {
      text_[size_] = c;
    }
    ++size_;
    if (capacity_ > 0) {
      text_[size_ < capacity_ ? size_ : capacity_ - 1] = '\0';
    }
  }
  void append(const char* string) {
    for (; *string != '\0'; ++string) {
      append(*string);
    }
  }
  void append(std::uint64_t number) {
    if (number >= 10) {
      append(number / 10);
    }
    append(static_cast<char>('0' + number % 10));
  }
  void append(double number);

 private:
  char* text_;
  std::size_t capacity_;
  std::size_t size_ = 0;
};

// Six decimals, without zeros at the end.
void Text::append(double number) {
  constexpr double kMillion = 1e6;
  if (std::isnan(number)) {
    return append("NaN");
  }
  if (number < 0.0) {
    append('-');
  }
  const double size = std::abs(number);
  if (!(size < 0x1p53)) {
    return append(size <= 0x1p64 ? "2^53 or more" : "infinity");
  }
  auto whole = static_cast<std::uint64_t>(size);
  auto decimals =
      static_cast<std::uint64_t>(std::llround((size - static_cast<double>(whole)) * kMillion));
  whole += decimals / 1000000;
  decimals %= 1000000;
  append(whole);
  if (decimals == 0) {
    return;
  }
  append('.');
  for (std::uint64_t digit = 100000; decimals > 0; digit /= 10) {
    append(decimals / digit);
    decimals %= digit;
  }
}

void append_place(const mien_error_detail& detail, Text& text) {
  const char* separator = "";
  const auto begin = [&](const char* word) {
    text.append(separator);
    text.append(word);
    separator = ", ";
  };
  const bool named = detail.name[0] != '\0';
  const bool in_network = detail.network >= 0;
  if (named) {
    begin(in_network || detail.field == nullptr ? "network" : detail.field);
    text.append(' ');
    text.append(detail.name);
  }
  if (detail.layer >= 0) {
    begin("layer ");
    text.append(static_cast<std::uint64_t>(detail.layer) + 1);
  }
  if ((detail.known & MIEN_DETAIL_OFFSET) != 0) {
    begin("byte ");
    text.append(detail.offset);
  }
  if (detail.field != nullptr && (in_network || !named)) {
    begin(detail.field);
  }
  text.append(separator[0] != '\0' ? ": " : "");
}

void append_values(const mien_error_detail& detail, Text& text) {
  const bool expected = (detail.known & MIEN_DETAIL_EXPECTED) != 0;
  if ((detail.known & MIEN_DETAIL_GOT) != 0) {
    text.append(" (got ");
    text.append(detail.got);
    if (expected) {
      text.append(", expected ");
      text.append(detail.expected_min);
      if (detail.expected_max != detail.expected_min) {
        text.append("..");
        text.append(detail.expected_max);
      }
    }
    text.append(')');
  }
}

}  // namespace

void mien_error_detail_default(mien_error_detail* detail) {
  if (detail != nullptr) {
    *detail = mien::formats::detail_of(MIEN_OK);
  }
}

size_t mien_error_message(const mien_error_detail* detail, char* text, size_t text_bytes) {
  Text line(text, text_bytes);
  if (text != nullptr && text_bytes > 0) {
    text[0] = '\0';
  }
  if (detail != nullptr) {
    const mien::kernels::FloatMode float_mode;
    append_place(*detail, line);
    line.append(mien_status_string(static_cast<mien_status>(detail->status)));
    append_values(*detail, line);
  }
  return line.size();
}
