// Checks characters of names and texts.
#include "formats/text.h"

#include <cstdint>

namespace mien::formats {
namespace {

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '/';
}

// First byte of a character, number of following bytes, and the range of the second: the rows of
// RFC 3629's grammar, which exclude overlong forms, surrogates and numbers above U+10FFFF.
struct Sequence {
  std::uint8_t first_low, first_high;
  std::uint8_t followers;
  std::uint8_t second_low, second_high;
};
constexpr Sequence kSequences[] = {
    {0x00, 0x7f, 0, 0x00, 0x00}, {0xc2, 0xdf, 1, 0x80, 0xbf}, {0xe0, 0xe0, 2, 0xa0, 0xbf},
    {0xe1, 0xec, 2, 0x80, 0xbf}, {0xed, 0xed, 2, 0x80, 0x9f}, {0xee, 0xef, 2, 0x80, 0xbf},
    {0xf0, 0xf0, 3, 0x90, 0xbf}, {0xf1, 0xf3, 3, 0x80, 0xbf}, {0xf4, 0xf4, 3, 0x80, 0x8f},
};

std::uint8_t byte_at(std::string_view text, std::size_t i) {
  return static_cast<std::uint8_t>(text[i]);
}

// Bytes of the first character of the text, 0 if it is not valid UTF-8.
std::size_t character_bytes(std::string_view text) {
  const std::uint8_t first = byte_at(text, 0);
  for (const Sequence& row : kSequences) {
    if (first < row.first_low || first > row.first_high) {
      continue;
    }
    bool good = row.followers < text.size();
    for (std::size_t i = 1; good && i <= row.followers; ++i) {
      const std::uint8_t low = i == 1 ? row.second_low : 0x80;
      const std::uint8_t high = i == 1 ? row.second_high : 0xbf;
      good = byte_at(text, i) >= low && byte_at(text, i) <= high;
    }
    return good ? row.followers + std::size_t{1} : 0;
  }
  return 0;
}

// Unicode's control characters (C0, delete and C1) except tab and line feed. C1 are two bytes long:
// U+0080 to U+009F.
bool is_control(std::string_view text) {
  const std::uint8_t c = byte_at(text, 0);
  return c == 0xc2 ? byte_at(text, 1) < 0xa0 : c == 0x7f || (c < 0x20 && c != '\t' && c != '\n');
}

}  // namespace

bool is_name(std::string_view text) {
  for (const char c : text) {
    if (!is_name_character(c)) {
      return false;
    }
  }
  return !text.empty();
}

bool is_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0 || is_control(text)) {
      return false;
    }
    text.remove_prefix(bytes);
  }
  return true;
}

}  // namespace mien::formats
