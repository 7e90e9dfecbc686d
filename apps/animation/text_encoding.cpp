// Detects and converts Unicode encodings.
#include "apps/animation/text_encoding.h"

#include <cstddef>

namespace mien::animation {
namespace {

using namespace std::string_view_literals;

enum class Encoding { kUtf8, kUtf16Little, kUtf16Big };

struct Found {
  Encoding encoding;
  std::size_t mark_bytes;
};

// Whether the first two characters are ASCII in UTF-16; `character` is the index of the non-zero
// byte.
bool ascii_in_pairs(std::string_view bytes, std::size_t character) {
  const std::size_t zero = 1 - character;
  return bytes.size() >= 4 && bytes[character] != '\0' && bytes[character + 2] != '\0' &&
         bytes[zero] == '\0' && bytes[zero + 2] == '\0';
}

Found encoding_of(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) {
    return {Encoding::kUtf8, 3};
  }
  if (bytes.starts_with("\xFF\xFE"sv)) {
    return {Encoding::kUtf16Little, 2};
  }
  if (bytes.starts_with("\xFE\xFF"sv)) {
    return {Encoding::kUtf16Big, 2};
  }
  if (ascii_in_pairs(bytes, 0)) {
    return {Encoding::kUtf16Little, 0};
  }
  return {ascii_in_pairs(bytes, 1) ? Encoding::kUtf16Big : Encoding::kUtf8, 0};
}

bool is_high_surrogate(char32_t unit) { return unit >= 0xD800 && unit < 0xDC00; }
bool is_low_surrogate(char32_t unit) { return unit >= 0xDC00 && unit < 0xE000; }

class Utf16 {
 public:
  Utf16(std::string_view bytes, bool big, std::size_t begin)
      : bytes_(bytes), big_(big), at_(begin) {}

  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

  bool next(char32_t& code, Fault& fault) {
    const std::size_t begin = at_;
    if (!unit(code, fault)) {
      return false;
    }
    char32_t low = 0;
    if (is_low_surrogate(code) ||
        (is_high_surrogate(code) && (at_end() || !unit(low, fault) || !is_low_surrogate(low)))) {
      return fail(fault, 0, begin, "unpaired UTF-16 surrogate");
    }
    code = low != 0 ? 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00) : code;
    return true;
  }

 private:
  bool unit(char32_t& value, Fault& fault) {
    if (bytes_.size() - at_ < 2) {
      return fail(fault, 0, at_, "truncated UTF-16 character");
    }
    const auto first = static_cast<unsigned char>(bytes_[at_]);
    const auto second = static_cast<unsigned char>(bytes_[at_ + 1]);
    value = big_ ? static_cast<char32_t>(first << 8 | second)
                 : static_cast<char32_t>(second << 8 | first);
    at_ += 2;
    return true;
  }

  std::string_view bytes_;
  bool big_;
  std::size_t at_;
};

}  // namespace

void append_utf8(char32_t code, std::string& text) {
  if (code < 0x80) {
    text += static_cast<char>(code);
    return;
  }
  const unsigned followers = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  constexpr unsigned kFirst[] = {0, 0xC0, 0xE0, 0xF0};
  text += static_cast<char>(kFirst[followers] | (code >> (6 * followers)));
  for (unsigned left = followers; left > 0; --left) {
    text += static_cast<char>(0x80 | ((code >> (6 * (left - 1))) & 0x3F));
  }
}

bool to_utf8(std::string_view bytes, std::string& converted, std::string_view& text, Fault& fault) {
  const auto [encoding, mark_bytes] = encoding_of(bytes);
  if (encoding == Encoding::kUtf8) {
    text = bytes.substr(mark_bytes);
    return true;
  }
  converted.clear();
  converted.reserve(bytes.size() / 2);
  Utf16 characters(bytes, encoding == Encoding::kUtf16Big, mark_bytes);
  while (!characters.at_end()) {
    char32_t code = 0;
    if (!characters.next(code, fault)) {
      return false;
    }
    append_utf8(code, converted);
  }
  text = converted;
  return true;
}

}  // namespace mien::animation
