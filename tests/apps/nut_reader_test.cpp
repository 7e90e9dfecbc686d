// Tests of reading ffmpeg's NUT streams: complete, truncated, and with flipped bits.
#include "apps/mien/sources/nut_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace mien::app {
namespace {

constexpr double kOffsetS = 1000.0;

std::vector<std::byte> made_by_ffmpeg(const std::string& options) {
  const std::string command =
      "ffmpeg -v error -nostdin " + options + " -output_ts_offset 1000 -f nut - </dev/null";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::vector<std::byte> bytes;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    bytes.push_back(static_cast<std::byte>(c));
  }
  return pclose(pipe) == 0 ? bytes : std::vector<std::byte>();
}

struct Contents {
  std::vector<NutPacket> packets;
  NutStatus end = NutStatus::kOk;
};

Contents read(std::span<const std::byte> bytes) {
  NutReader reader(formats::span_source(&bytes), kOffsetS);
  Contents contents;
  NutPacket packet;
  while ((contents.end = reader.next(packet)) == NutStatus::kOk) {
    contents.packets.push_back(packet);
  }
  return contents;
}

const char* const kBoth =
    "-f lavfi -i testsrc=size=8x6:rate=30000/1001:duration=1 -f lavfi -i sine=duration=1 -map 0:v "
    "-map 1:a -c:v rawvideo -pix_fmt rgb24 -ac 1 -ar 16000 -c:a pcm_s16le";

TEST(NutReader, ReadsPacketsAndTimestamps) {
  const std::vector<std::byte> bytes = made_by_ffmpeg(kBoth);
  if (bytes.empty()) {
    GTEST_SKIP() << "skipped: ffmpeg is not installed";
  }
  const Contents contents = read(bytes);
  EXPECT_EQ(contents.end, NutStatus::kEnd);
  int frames = 0;
  std::size_t samples = 0;
  for (const NutPacket& packet : contents.packets) {
    if (packet.stream == 0) {
      EXPECT_NEAR(packet.time_s, frames++ * 1001.0 / 30000.0, 1e-9);
      EXPECT_EQ(packet.data.size(), 8u * 6u * 3u);
    } else {
      EXPECT_NEAR(packet.time_s, static_cast<double>(samples) / 16000.0, 1e-9);
      samples += packet.data.size() / 2;
    }
  }
  EXPECT_EQ(frames, 30);
  EXPECT_NEAR(static_cast<double>(samples), 16000.0, 1.0);
}

// Time bases above a second, and times of a day.
TEST(NutReader, TimesOfSlowStreamsAreExact) {
  const std::vector<std::byte> bytes =
      made_by_ffmpeg("-f lavfi -i color=s=4x4:r=3/10000 -frames:v 30 -c:v rawvideo -pix_fmt rgb24");
  if (bytes.empty()) {
    GTEST_SKIP() << "skipped: ffmpeg is not installed";
  }
  const Contents contents = read(bytes);
  ASSERT_EQ(contents.packets.size(), 30u);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_NEAR(contents.packets[i].time_s, static_cast<double>(i) * 10000.0 / 3.0, 1e-6);
  }
}

TEST(NutReader, GivesOnlyCompletePacketsOfATruncatedStream) {
  const std::vector<std::byte> bytes = made_by_ffmpeg(kBoth);
  if (bytes.empty()) {
    GTEST_SKIP() << "skipped: ffmpeg is not installed";
  }
  const std::vector<NutPacket> whole = read(bytes).packets;
  for (std::size_t length = 0; length < bytes.size(); length += length < 2000 ? 1 : 997) {
    const Contents cut = read(std::span(bytes).first(length));
    ASSERT_LE(cut.packets.size(), whole.size());
    EXPECT_NE(cut.end, NutStatus::kOk);
    for (std::size_t i = 0; i < cut.packets.size(); ++i) {
      EXPECT_EQ(cut.packets[i].data, whole[i].data);
      EXPECT_EQ(cut.packets[i].time_s, whole[i].time_s);
    }
  }
}

TEST(NutReader, SurvivesEveryBitFlippedInItsHeaders) {
  const std::vector<std::byte> bytes = made_by_ffmpeg(kBoth);
  if (bytes.empty()) {
    GTEST_SKIP() << "skipped: ffmpeg is not installed";
  }
  std::vector<std::byte> flipped(bytes.begin(), bytes.begin() + 6000);
  for (std::size_t i = 0; i < 700 * 8; ++i) {
    flipped[i / 8] ^= static_cast<std::byte>(1u << (i % 8));
    for (const NutPacket& packet : read(flipped).packets) {
      EXPECT_LT(packet.stream, 16u);
      EXPECT_TRUE(std::isfinite(packet.time_s));
      EXPECT_LE(packet.data.size(), flipped.size());
    }
    flipped[i / 8] ^= static_cast<std::byte>(1u << (i % 8));
  }
}

}  // namespace
}  // namespace mien::app
