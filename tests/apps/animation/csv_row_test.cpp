// Tests of CSV rows.
#include "apps/animation/csv_row.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <random>
#include <string>

namespace mien::animation {
namespace {

TEST(CsvRow, WritesCells) {
  std::array<char, 200> buffer;
  CsvRow row(buffer);
  row.add(std::int64_t{-12});
  row.add(0.1f);
  row.add_empty();
  row.add(std::string_view("tracking"));
  row.add(0.1);
  EXPECT_EQ(row.finish(), "-12,0.1,,tracking,0.1\n");
  row.add_empty();
  row.add_empty();
  EXPECT_EQ(row.finish(), ",\n");
  EXPECT_EQ(row.finish(), "\n");
}

TEST(CsvRow, QuotesAsRfc4180Requires) {
  std::array<char, 200> buffer;
  CsvRow row(buffer);
  row.add(std::string_view("a,b"));
  row.add(std::string_view("say \"x\""));
  row.add(std::string_view("two\nlines"));
  row.add(std::string_view(""));
  EXPECT_EQ(row.finish(), "\"a,b\",\"say \"\"x\"\"\",\"two\nlines\",\n");
}

TEST(CsvRow, UnknownNumbersAreEmpty) {
  std::array<char, 200> buffer;
  CsvRow row(buffer);
  row.add(std::numeric_limits<float>::quiet_NaN());
  row.add(std::numeric_limits<float>::infinity());
  row.add(-std::numeric_limits<double>::infinity());
  row.add(1.0f);
  EXPECT_EQ(row.finish(), ",,,1\n");
}

template <typename Number>
Number read_back(const std::string& row) {
  Number value = 0;
  std::from_chars(row.data(), row.data() + row.size(), value);
  return value;
}

TEST(CsvRow, FloatsRoundTrip) {
  std::mt19937 random(1);
  std::array<char, CsvRow::kMaxNumberBytes + 1> buffer;
  std::size_t longest = 0;
  for (int i = 0; i < 200000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    CsvRow row(buffer);
    row.add(value);
    const std::string text(row.finish());
    ASSERT_FALSE(text.empty());
    if (std::isfinite(value)) {
      EXPECT_EQ(read_back<float>(text), value) << text;
      longest = std::max(longest, text.size() - 1);
    }
  }
  EXPECT_LE(longest, 15u);  // sign, 9 digits, point, e-38
}

TEST(CsvRow, DoublesAndIntegersFitTheirCell) {
  std::array<char, CsvRow::kMaxNumberBytes + 1> buffer;
  for (const double value :
       {-std::numeric_limits<double>::max(), -2.2250738585072014e-308,
        -std::numeric_limits<double>::denorm_min(), -1.2345678901234567e-300}) {
    CsvRow row(buffer);
    row.add(value);
    const std::string text(row.finish());
    EXPECT_EQ(read_back<double>(text), value) << text;
  }
  CsvRow row(buffer);
  row.add(std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(row.finish(), "-9223372036854775808\n");
}

TEST(CsvRow, ATooSmallBufferIsEmptyAndNotExceeded) {
  const std::string whole = "-12,0.25,text\n";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    std::string buffer(size, '\xaa');  // the address sanitizer checks its end
    CsvRow row(buffer);
    row.add(std::int64_t{-12});
    row.add(0.25f);
    row.add(std::string_view("text"));
    EXPECT_EQ(row.finish(), size < whole.size() ? "" : whole);
    row.add_empty();
    EXPECT_EQ(row.finish(), size < 1 ? "" : "\n");
  }
}

}  // namespace
}  // namespace mien::animation
