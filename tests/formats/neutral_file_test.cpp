// Tests of neutral files.
#include "formats/neutral_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "formats/xxhash64.h"

namespace mien::tests {
namespace {

using formats::kNeutralFileBytes;
using formats::NeutralFile;
using Bytes = std::array<std::byte, kNeutralFileBytes>;

NeutralFile sample() {
  NeutralFile neutral;
  neutral.captured = 2;
  for (std::size_t i = 0; i < formats::kNeutralLevels; ++i) {
    neutral.levels[i] = static_cast<float>(i) / 104.0f;
  }
  return neutral;
}

Bytes written(const NeutralFile& neutral) {
  Bytes bytes;
  formats::write_neutral_file(neutral, bytes);
  return bytes;
}

TEST(NeutralFile, RoundTrips) {
  NeutralFile back;
  ASSERT_EQ(formats::read_neutral_file(written(sample()), back), MIEN_OK);
  EXPECT_EQ(back.captured, 2u);
  for (std::size_t i = 0; i < formats::kNeutralLevels; ++i) {
    EXPECT_EQ(back.levels[i], sample().levels[i]);
  }
}

// The layout of docs/format.md, so that files remain readable.
TEST(NeutralFile, IsLaidOutAsDocumented) {
  const Bytes bytes = written(sample());
  EXPECT_EQ(std::memcmp(bytes.data(), "MIENNEUT\1\0\0\0\64\0\0\0\2\0\0\0\0\0\0\0", 24), 0);
  float second = 0.0f;
  std::memcpy(&second, bytes.data() + 28, sizeof second);  // little-endian, like the machine
  EXPECT_EQ(second, sample().levels[1]);
}

TEST(NeutralFile, AnyChangedByteIsDetected) {
  for (std::size_t i = 0; i < kNeutralFileBytes; ++i) {
    Bytes bytes = written(sample());
    bytes[i] ^= std::byte{0x10};
    NeutralFile back;
    back.captured = 77;
    EXPECT_NE(formats::read_neutral_file(bytes, back), MIEN_OK) << i;
    EXPECT_EQ(back.captured, 77u) << "the output stays unchanged";
  }
}

TEST(NeutralFile, NamesTheError) {
  const Bytes good = written(sample());
  NeutralFile back;
  const std::span<const std::byte> all = good;
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_EQ(formats::read_neutral_file(all.first(size), back),
              size < 8 ? MIEN_ERROR_NEUTRAL_FORMAT : MIEN_ERROR_NEUTRAL_DAMAGED);
  }
  std::array<std::byte, kNeutralFileBytes + 8> longer = {};  // with a valid checksum
  std::copy(good.begin(), good.end(), longer.begin());
  const std::size_t at = kNeutralFileBytes - sizeof(std::uint64_t);
  const std::uint64_t sum = formats::xxhash64_with_hole(longer, at);
  std::memcpy(longer.data() + at, &sum, sizeof sum);
  EXPECT_EQ(formats::read_neutral_file(longer, back), MIEN_ERROR_NEUTRAL_DAMAGED);
  Bytes later = good;
  later[8] = std::byte{2};
  EXPECT_EQ(formats::read_neutral_file(later, back), MIEN_ERROR_NEUTRAL_VERSION);
  for (const float bad : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()}) {
    NeutralFile wrong = sample();
    wrong.levels[60] = bad;
    EXPECT_EQ(formats::read_neutral_file(written(wrong), back), MIEN_ERROR_NEUTRAL_DAMAGED);
  }
}

}  // namespace
}  // namespace mien::tests
