// Escapes text and removes credentials from it.
#include "apps/mien/system/printable.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

namespace mien::app {
namespace {

constexpr std::string_view kReplacement = "***";
constexpr std::string_view kEndsUrl = " \t\r\n'\"<>";

bool is_secret(std::string key) {
  constexpr std::array<std::string_view, 7> kWords = {"pass", "pwd",    "token", "key",
                                                      "auth", "secret", "sig"};
  std::transform(key.begin(), key.end(), key.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return key == "user" || std::any_of(kWords.begin(), kWords.end(), [&](std::string_view word) {
           return key.find(word) != std::string::npos;
         });
}

// "a=1&password=2" with its secret values replaced.
std::string redacted_values(std::string_view query) {
  std::string result;
  while (!query.empty()) {
    const std::size_t end = std::min(query.find_first_of("&;"), query.size());
    const std::string_view parameter = query.substr(0, end);
    const std::size_t equals = parameter.find('=');
    if (equals != std::string_view::npos && is_secret(std::string(parameter.substr(0, equals)))) {
      result.append(parameter.substr(0, equals + 1)).append(kReplacement);
    } else {
      result.append(parameter);
    }
    result.append(query.substr(end, 1));
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return result;
}

// The part of a URL after "://".
std::string redacted_url(std::string_view rest) {
  const std::size_t authority = std::min(rest.find_first_of("/?#"), rest.size());
  // A password that is not percent-encoded may contain a '/', so everything before an '@' belongs
  // to the user information.
  std::size_t at = rest.substr(0, authority).rfind('@');
  if (at == std::string_view::npos) {
    const std::size_t colon = rest.substr(0, authority).find(':');
    const std::size_t later = rest.substr(0, rest.find('?')).rfind('@');
    at = colon != std::string_view::npos && later != std::string_view::npos ? later : at;
  }
  std::string result;
  if (at != std::string_view::npos) {
    result.append(kReplacement).append("@");
    rest.remove_prefix(at + 1);
  }
  const std::size_t query = std::min(rest.find('?'), rest.size());
  result.append(rest.substr(0, query)).append(rest.substr(query, 1));
  return result + redacted_values(rest.substr(std::min(query + 1, rest.size())));
}

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};

Character utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t bytes = first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (bytes == 1) {
    return {first, 1, true};
  }
  constexpr std::array<std::uint32_t, 5> kMinCode = {0, 0, 0x80, 0x800, 0x10000};
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) {
    return {first, 1, false};
  }
  std::uint32_t code = first & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) {
      return {first, 1, false};
    }
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  const bool valid =
      code >= kMinCode[bytes] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
  return valid ? Character{code, bytes, true} : Character{first, 1, false};
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

bool changes_text_direction(std::uint32_t code) {
  return (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
         code == 0x200E || code == 0x200F || code == 0x2028 || code == 0x2029;
}

std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character next = utf8(text);
    std::array<char, 12> code{};
    if (!next.valid || is_control(next.code)) {
      std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned>(next.code));
      result += code.data();
    } else if (changes_text_direction(next.code)) {
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(next.code));
      result += code.data();
    } else {
      result.append(text.substr(0, next.bytes));
    }
    text.remove_prefix(next.bytes);
  }
  return result;
}

}  // namespace

std::string without_credentials(std::string_view text) {
  constexpr std::string_view kScheme = "://";
  std::string result;
  for (std::size_t at = text.find(kScheme); at != std::string_view::npos; at = text.find(kScheme)) {
    result.append(text.substr(0, at + kScheme.size()));
    text.remove_prefix(at + kScheme.size());
    const std::size_t end = std::min(text.find_first_of(kEndsUrl), text.size());
    result += redacted_url(text.substr(0, end));
    text.remove_prefix(end);
  }
  return result.append(text);
}

std::string printable(std::string_view text) { return escaped(without_credentials(text)); }

}  // namespace mien::app
