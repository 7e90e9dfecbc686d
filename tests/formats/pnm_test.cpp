// Tests of PNM images.
#include "formats/pnm.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace mien::formats {
namespace {

struct Result {
  PnmStatus status;
  PnmImage image;
};

// Reads a copy whose end the address sanitizer checks.
Result read(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  const std::vector<std::byte> copy(bytes.begin(), bytes.end());
  Result result{};
  result.image.width = 77;
  result.status = read_pnm(copy, &result.image);
  if (result.status != PnmStatus::kOk) {
    EXPECT_EQ(result.image.width, 0u);
    EXPECT_TRUE(result.image.pixels.empty());
  }
  result.image.pixels = {};
  return result;
}

TEST(Pnm, ReadsGreyAndColour) {
  const std::string file = std::string("P6\n# made by hand\n2 1\n255\n") + "abcdef";
  PnmImage image;
  ASSERT_EQ(read_pnm(std::as_bytes(std::span(file)), &image), PnmStatus::kOk);
  EXPECT_EQ(image.width, 2u);
  EXPECT_EQ(image.height, 1u);
  EXPECT_EQ(image.channels, 3u);
  ASSERT_EQ(image.pixels.size(), 6u);
  EXPECT_EQ(image.pixels[0], std::byte{'a'});
  const Result grey = read("P5 3\t2 # wide\r\n 255 123456");
  EXPECT_EQ(grey.status, PnmStatus::kOk);
  EXPECT_EQ(grey.image.channels, 1u);
}

TEST(Pnm, PixelsMayLookLikeWhitespaceAndComments) {
  EXPECT_EQ(read("P5 2 1 255 # ").status, PnmStatus::kOk);
  EXPECT_EQ(read("P5 2 1 255\n\n\n").status, PnmStatus::kOk);
}

TEST(Pnm, RejectsEverythingElse) {
  EXPECT_EQ(read("").status, PnmStatus::kBadSignature);
  EXPECT_EQ(read("P").status, PnmStatus::kBadSignature);
  EXPECT_EQ(read("P3 1 1 255 0").status, PnmStatus::kBadSignature);
  EXPECT_EQ(read("\x89PNG").status, PnmStatus::kBadSignature);
  for (const char* bad :
       {"P5", "P5 ", "P51 1 255\nx", "P5 0 1 255 ", "P5 1 0 255 ", "P5 -1 1 255 x", "P5 +1 1 255 x",
        "P5 16385 1 255 x", "P5 1 4294967297 255 x", "P5 99999999999999999999 1 255 x",
        "P5 1.5 1 255 x", "P5 # 1 1 255 x"}) {
    EXPECT_EQ(read(bad).status, PnmStatus::kBadSize) << bad;
  }
  for (const char* bad : {"P5 1 1", "P5 1 1 x", "P5 1 1 0 x", "P5 1 1 254 x", "P5 1 1 65535 xx"}) {
    EXPECT_EQ(read(bad).status, PnmStatus::kUnsupportedDepth) << bad;
  }
  EXPECT_EQ(read("P5 1 1 255").status, PnmStatus::kBadHeader);
  EXPECT_EQ(read("P5 1 1 255#").status, PnmStatus::kBadHeader);
  EXPECT_EQ(read("P5 2 1 255 a").status, PnmStatus::kTruncated);
  EXPECT_EQ(read("P6 16384 16384 255 a").status, PnmStatus::kTruncated);
  EXPECT_EQ(read("P5 1 1 255 ab").status, PnmStatus::kTrailingBytes);
}

TEST(Pnm, TruncatedAtEveryByte) {
  const std::string file = "P6 # c\n2 2\n255\nabcdefghijkl";
  EXPECT_EQ(read(file).status, PnmStatus::kOk);
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_NE(read(file.substr(0, size)).status, PnmStatus::kOk) << size;
  }
}

TEST(Pnm, EveryStatusHasItsOwnMessage) {
  std::set<std::string> messages;
  for (std::uint8_t i = 0; i < kPnmStatusCount; ++i) {
    messages.insert(message(static_cast<PnmStatus>(i)));
  }
  EXPECT_EQ(messages.size(), kPnmStatusCount);
  EXPECT_EQ(messages.count("unknown status"), 0u);
  EXPECT_STREQ(message(static_cast<PnmStatus>(kPnmStatusCount)), "unknown status");
}

}  // namespace
}  // namespace mien::formats
