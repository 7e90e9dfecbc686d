// Escapes of JSON strings.
#include "apps/animation/json_text.h"

#include <cstdint>
#include <optional>

#include "apps/animation/text_encoding.h"

namespace mien::animation {
namespace {

constexpr std::string_view kLetters = "\"\\/bfnrt";
constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";

std::optional<std::uint32_t> hex4(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdefABCDEF";
  if (text.size() < 4) {
    return std::nullopt;
  }
  std::uint32_t value = 0;
  for (const char c : text.substr(0, 4)) {
    const std::size_t digit = kDigits.find(c);
    if (digit == kDigits.npos) {
      return std::nullopt;
    }
    value = value * 16 + static_cast<std::uint32_t>(digit < 16 ? digit : digit - 6);
  }
  return value;
}

bool is_high(std::uint32_t code) { return code >= 0xD800 && code < 0xDC00; }
bool is_low(std::uint32_t code) { return code >= 0xDC00 && code < 0xE000; }

}  // namespace

std::size_t json_string_bytes(std::string_view text) {
  std::size_t at = 1;
  while (text[at] != '"') {
    at += text[at] == '\\' ? 2 : 1;
  }
  return at + 1;
}

std::size_t json_escape_bytes(std::string_view text, const char*& wrong) {
  if (text.empty() || (text[0] != 'u' && kLetters.find(text[0]) == kLetters.npos)) {
    wrong = "unknown escape sequence";
    return 0;
  }
  if (text[0] != 'u') {
    return 1;
  }
  const std::optional<std::uint32_t> code = hex4(text.substr(1));
  if (!code) {
    wrong = "expected four hexadecimal digits";
    return 0;
  }
  if (!is_high(*code) && !is_low(*code)) {
    return 5;
  }
  const auto low = text.substr(5).starts_with("\\u") ? hex4(text.substr(7)) : std::nullopt;
  if (!is_high(*code) || !low || !is_low(*low)) {
    wrong = "unpaired surrogate";
    return 0;
  }
  return 11;
}

std::string json_unescaped(std::string_view inside) {
  std::string text;
  text.reserve(inside.size());
  while (!inside.empty()) {
    const std::size_t plain = inside.find('\\');
    text += inside.substr(0, plain);
    if (plain == inside.npos) {
      break;
    }
    inside.remove_prefix(plain + 1);
    const char* ignored = nullptr;
    const std::size_t bytes = json_escape_bytes(inside, ignored);
    if (bytes == 1) {
      text += kMeanings[kLetters.find(inside[0])];
    } else {
      const std::uint32_t code = hex4(inside.substr(1)).value_or(0);
      const std::uint32_t low = bytes == 11 ? hex4(inside.substr(7)).value_or(0) : 0;
      append_utf8(bytes == 11 ? 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00) : code, text);
    }
    inside.remove_prefix(bytes);
  }
  return text;
}

}  // namespace mien::animation
