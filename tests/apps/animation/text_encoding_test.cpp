// Tests of Unicode encodings and JSON escapes.
#include "apps/animation/text_encoding.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/animation/fault.h"
#include "apps/animation/json_text.h"

namespace mien::animation {
namespace {

using namespace std::string_view_literals;

struct Character {
  std::u16string_view utf16;
  std::string_view utf8;
};

// The first and the last character of each length in UTF-8 and in UTF-16.
constexpr Character kCharacters[] = {{u"\u0001", "\x01"},
                                     {u"\u007f", "\x7f"},
                                     {u"\u0080", "\xC2\x80"},
                                     {u"\u07ff", "\xDF\xBF"},
                                     {u"\u0800", "\xE0\xA0\x80"},
                                     {u"\ud7ff", "\xED\x9F\xBF"},
                                     {u"\ue000", "\xEE\x80\x80"},
                                     {u"\uffff", "\xEF\xBF\xBF"},
                                     {u"\U00010000", "\xF0\x90\x80\x80"},
                                     {u"\U000103ff", "\xF0\x90\x8F\xBF"},
                                     {u"\U00010400", "\xF0\x90\x90\x80"},
                                     {u"\U0010ffff", "\xF4\x8F\xBF\xBF"}};

std::string bytes_of(std::u16string_view text, bool big) {
  std::string bytes;
  for (const char16_t unit : text) {
    const std::string pair = {static_cast<char>(unit >> 8), static_cast<char>(unit & 0xff)};
    bytes += big ? pair : std::string{pair[1], pair[0]};
  }
  return bytes;
}

std::string utf8_of(std::string_view bytes) {
  std::string converted;
  std::string_view text;
  Fault fault;
  return to_utf8(bytes, converted, text, fault) ? std::string(text) : describe(fault);
}

TEST(TextEncoding, Utf16IsConvertedInEitherByteOrder) {
  for (const Character& character : kCharacters) {
    EXPECT_EQ(utf8_of("\xFE\xFF" + bytes_of(character.utf16, true)), character.utf8);
    EXPECT_EQ(utf8_of("\xFF\xFE" + bytes_of(character.utf16, false)), character.utf8);
  }
}

TEST(TextEncoding, WithoutAMarkTwoAsciiCharactersDetermineTheByteOrder) {
  for (const bool big : {false, true}) {
    EXPECT_EQ(utf8_of(bytes_of(u"{}\u00e4", big)), "{}\xC3\xA4");
    EXPECT_EQ(utf8_of(bytes_of(u"{}", big)), "{}");
    EXPECT_EQ(utf8_of(bytes_of(u"{", big)), bytes_of(u"{", big)) << "one is not enough";
    EXPECT_EQ(utf8_of(bytes_of(u"{\u0100", big)), bytes_of(u"{\u0100", big));
  }
}

TEST(TextEncoding, Utf8IsUnchangedExceptForItsMark) {
  EXPECT_EQ(utf8_of("\xEF\xBB\xBF{}"), "{}");
  EXPECT_EQ(utf8_of("{}"), "{}");
  EXPECT_EQ(utf8_of("\xEF\xBB\xBF"), "");
  EXPECT_EQ(utf8_of(""), "");
}

TEST(TextEncoding, ErrorsOfUtf16HaveAnOffset) {
  const std::string half = "unpaired UTF-16 surrogate";
  const std::vector<std::pair<std::u16string, std::string>> cases = {
      {u"ab\xd800", "byte 6: " + half},       {u"ab\xd800z", "byte 6: " + half},
      {u"ab\xdbff\xd800", "byte 6: " + half}, {u"ab\xdc00", "byte 6: " + half},
      {u"a\xdfff\xdc00", "byte 4: " + half},  {u"ab\xd800\xe000", "byte 6: " + half}};
  for (const auto& [text, fault] : cases) {
    EXPECT_EQ(utf8_of("\xFE\xFF" + bytes_of(text, true)), fault);
    EXPECT_EQ(utf8_of("\xFF\xFE" + bytes_of(text, false)), fault);
  }
  EXPECT_EQ(utf8_of("\xFE\xFF\0a\0"sv), "byte 4: truncated UTF-16 character");
}

TEST(JsonText, EveryHexadecimalDigitCounts) {
  for (const std::string_view escape :
       {"\\u1234", "\\u5678", "\\u9abc", "\\u9ABC", "\\udbff\\udfff", "\\uDBFF\\uDFFF", "\\uD7ff",
        "\\ue000", "\\ueFeF"}) {
    const char* wrong = nullptr;
    EXPECT_EQ(json_escape_bytes(escape.substr(1), wrong), escape.size() - 1) << escape;
  }
  EXPECT_EQ(json_unescaped("\\u1234\\u5678"), "\xE1\x88\xB4\xE5\x99\xB8");
  EXPECT_EQ(json_unescaped("\\u9abc\\u9ABC"), "\xE9\xAA\xBC\xE9\xAA\xBC");
  EXPECT_EQ(json_unescaped("\\ueFeF\\uEfEf"), "\xEE\xBF\xAF\xEE\xBF\xAF");
  EXPECT_EQ(json_unescaped("\\uDBFF\\udFfF"), "\xF4\x8F\xBF\xBF");
  EXPECT_EQ(json_unescaped("\\uDBFe\\uDc00"), "\xF4\x8F\xA0\x80");
  EXPECT_EQ(json_unescaped("\\ud800\\uDC00 \\u0041"), "\xF0\x90\x80\x80 A");
}

TEST(JsonText, NamesTheErrorOfAnEscape) {
  const std::string no_such = "unknown escape sequence",
                    digits = "expected four hexadecimal digits", half = "unpaired surrogate";
  const std::vector<std::pair<std::string_view, std::string>> cases = {
      {"", no_such},         {"q", no_such},         {"U0041", no_such},     {"u", digits},
      {"u123", digits},      {"u123g", digits},      {"u 123", digits},      {"ud800", half},
      {"udbff\\n", half},    {"udc00", half},        {"udfff\\udc00", half}, {"ud800\\ud800", half},
      {"ud800\\udc0", half}, {"ud800\\ue000", half}, {"ud800 udc00", half}};
  for (const auto& [escape, fault] : cases) {
    const char* wrong = "";
    EXPECT_EQ(json_escape_bytes(escape, wrong), 0u) << escape;
    EXPECT_EQ(wrong, fault) << escape;
  }
}

}  // namespace
}  // namespace mien::animation
