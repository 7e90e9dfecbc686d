// Converts numbers to text and back.
#include "apps/animation/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

namespace mien::animation {
namespace {

// Digits of the largest double in fixed notation with all decimals used here.
constexpr std::size_t kMaxDigits = 400;

// Requires the whole text to be a number.
template <class Number>
bool read(std::string_view digits, Number& value) {
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return !digits.empty() && error == std::errc() && end == digits.data() + digits.size();
}

#ifndef __cpp_lib_to_chars
// Apple's library does not parse doubles this way. The program sets no locale.
template <>
bool read(std::string_view digits, double& value) {
  const std::string text(digits);
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return text.find_first_not_of("+-.0123456789eE") == std::string::npos && !text.starts_with('+') &&
         !text.empty() && end == text.c_str() + text.size();
}
#endif

template <class Number>
bool parse(std::string_view text, Number& value) {
  Number number{};
  if (!read(trimmed(text), number)) {
    return false;
  }
  value = number;
  return true;
}

}  // namespace

std::string shortest(double value) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end};
}

std::string fixed(double value, int decimals) {
  std::array<char, kMaxDigits> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::fixed, decimals);
  if (error != std::errc()) {
    return shortest(value);
  }
  std::string text(digits.data(), end);
  if (text.find_first_not_of("-0.") == std::string::npos && text.starts_with('-')) {
    text.erase(0, 1);  // zero has no sign
  }
  return text;
}

double decimal(float value) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  double number = 0.0;
  read({digits.data(), static_cast<std::size_t>(end - digits.data())}, number);
  return number;
}

bool parse_number(std::string_view text, double& value) {
  double number = 0.0;
  if (!parse(text, number) || !std::isfinite(number)) {
    return false;
  }
  value = number;
  return true;
}

bool parse_number(std::string_view text, std::int64_t& value) { return parse(text, value); }

std::string_view trimmed(std::string_view text, std::string_view blanks) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMaxBytes = 40;
  std::string excerpt(trimmed(text).substr(0, kMaxBytes));
  for (char& c : excerpt) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f) {
      c = '?';
    }
  }
  return "'" + excerpt + "'";
}

}  // namespace mien::animation
