// Tests of checked arithmetic, checksums and text checks.
#include "formats/checked.h"

#include <gtest/gtest.h>

#include "formats/text.h"
#include "formats/xxhash64.h"

namespace mien::formats {
namespace {

#ifdef __SIZEOF_INT128__  // the reference for comparison; 32-bit machines lack it
TEST(Checked, DetectsOverflowOfSumsAndProducts) {
  constexpr std::uint64_t kMax = UINT64_MAX;
  const std::uint64_t values[] = {
      0,          1,          2,         63,       64,  1ull << 31, 1ull << 32, (1ull << 32) - 1,
      1ull << 62, 1ull << 63, kMax - 63, kMax - 1, kMax};
  for (const std::uint64_t a : values) {
    for (const std::uint64_t b : values) {
      const auto sum = static_cast<unsigned __int128>(a) + b;
      const auto product = static_cast<unsigned __int128>(a) * b;
      EXPECT_EQ((Checked(a) + b).valid(), sum <= kMax);
      EXPECT_EQ((Checked(a) * b).valid(), product <= kMax);
      EXPECT_EQ((Checked(a) + b).value(), sum <= kMax ? static_cast<std::uint64_t>(sum) : kMax);
      EXPECT_EQ((Checked(a) * b).value(),
                product <= kMax ? static_cast<std::uint64_t>(product) : kMax);
    }
  }
}
#endif

TEST(Checked, StaysPoisoned) {
  const Checked wrapped = Checked(UINT64_MAX) + 1;
  EXPECT_FALSE(wrapped.valid());
  EXPECT_FALSE((wrapped + 0).valid());
  EXPECT_FALSE((wrapped * 0).valid());
  EXPECT_FALSE((Checked(0) * wrapped).valid());
  EXPECT_FALSE(wrapped.aligned(64).valid());
}

TEST(Checked, Aligns) {
  EXPECT_EQ(Checked(0).aligned(64).value(), 0u);
  EXPECT_EQ(Checked(1).aligned(64).value(), 64u);
  EXPECT_EQ(Checked(64).aligned(64).value(), 64u);
  EXPECT_FALSE(Checked(UINT64_MAX - 62).aligned(64).valid());
}

std::uint64_t hash_of(std::string_view text) {
  return xxhash64_with_hole(std::as_bytes(std::span(text)), text.size() + 64);
}

// Values of the reference implementation (xxhsum -H64).
TEST(Xxhash64, PublishedValues) {
  EXPECT_EQ(hash_of(""), 0xEF46DB3751D8E999u);
  EXPECT_EQ(hash_of("a"), 0xD24EC4F1A98C6E5Bu);
  EXPECT_EQ(hash_of("abc"), 0x44BC2CF5AD770999u);
  // cspell:ignore spammish
  EXPECT_EQ(hash_of("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1u);
}

TEST(Xxhash64, TheChecksumFieldCountsAsZero) {
  std::string text(200, 'x');
  std::string zeroed = text;
  zeroed.replace(56, 8, 8, '\0');
  EXPECT_EQ(xxhash64_with_hole(std::as_bytes(std::span(text)), 56), hash_of(zeroed));
  EXPECT_NE(hash_of(text), hash_of(zeroed));
}

TEST(Text, IsUtf8WithoutControlCharacters) {
  for (const char* good :
       {"", "plain\ttext\n", "\xc2\xa0", "\xc3\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
        "\xee\x80\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf", "a\xc3\xa9z"}) {
    EXPECT_TRUE(is_text(good)) << good;
  }
  for (const char* bad : {"\r", "\x1b[31m", "\x7f", "\x80", "\xbf", "\xc0\xaf", "\xc1\xbf", "\xc2",
                          "\xc2 ", "\xe0\x9f\xbf", "\xe2\x82", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
                          "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff"}) {
    EXPECT_FALSE(is_text(bad)) << bad;
  }
  EXPECT_FALSE(is_text(std::string_view("a\0b", 3)));
  for (char c = '\0'; c < ' '; ++c) {
    EXPECT_EQ(is_text({&c, 1}), c == '\t' || c == '\n') << static_cast<int>(c);
  }
  for (int c = 0x80; c < 0xC0; ++c) {
    const char character[] = {'\xC2', static_cast<char>(c)};
    EXPECT_EQ(is_text({character, 2}), c >= 0xA0) << "C1 ends before U+00A0: " << c;
  }
}

TEST(Text, NamesAreLowerCase) {
  EXPECT_TRUE(is_name("az_09./"));
  for (const char* bad : {"", "A", "a b", "-", "\xc3\xa9", "a\n"}) {
    EXPECT_FALSE(is_name(bad)) << bad;
  }
}

}  // namespace
}  // namespace mien::formats
