// Tests of Y4M video.
#include "formats/y4m.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <string>
#include <vector>

namespace mien::formats {
namespace {

Y4mStatus open_text(const std::string& text, Y4mHeader* header = nullptr) {
  std::span<const std::byte> left = std::as_bytes(std::span(text));
  Y4mReader reader;
  const Y4mStatus status = reader.open(span_source(&left));
  if (header != nullptr) {
    *header = reader.header();
  }
  if (status != Y4mStatus::kOk) {
    EXPECT_EQ(reader.header().width, 0u);
    EXPECT_EQ(reader.header().rate_num, 0u);
    EXPECT_EQ(reader.read_frame({}), Y4mStatus::kEnd);
  }
  return status;
}

// Status of the first read that does not return a frame.
Y4mStatus read_all(const std::string& text, int* frames) {
  std::span<const std::byte> left = std::as_bytes(std::span(text));
  Y4mReader reader;
  Y4mStatus status = reader.open(span_source(&left));
  std::vector<std::byte> frame(reader.header().frame_bytes());
  for (*frames = 0; status == Y4mStatus::kOk; *frames += status == Y4mStatus::kOk ? 1 : 0) {
    status = reader.read_frame(frame);
  }
  return status;
}

TEST(Y4m, ReadsThePixelAspectRatio) {
  const auto aspect = [](const char* parameter) {
    Y4mHeader header;
    const std::string text = std::string("YUV4MPEG2 W2 H2 F25:1 ") + parameter + "\n";
    EXPECT_EQ(open_text(text, &header), Y4mStatus::kOk) << parameter;
    return header.pixel_aspect();
  };
  EXPECT_DOUBLE_EQ(aspect("A4:3"), 4.0 / 3.0);
  EXPECT_DOUBLE_EQ(aspect("A8:9"), 8.0 / 9.0);
  for (const char* unknown :
       {"A0:0", "A1:0", "A0:1", "A", "A4", "Ax:y", "A1:1000", "A1000:1", ""}) {
    EXPECT_EQ(aspect(unknown), 1.0) << unknown;
  }
}

TEST(Y4m, ReadsTheHeader) {
  Y4mHeader header;
  ASSERT_EQ(
      open_text(
          "YUV4MPEG2 W640 H480 F30000:1001 Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=FULL\n",
          &header),
      Y4mStatus::kOk);
  EXPECT_EQ(header.width, 640u);
  EXPECT_EQ(header.height, 480u);
  EXPECT_EQ(header.rate_num, 30000u);
  EXPECT_EQ(header.rate_den, 1001u);
  EXPECT_EQ(header.colour, Y4mColour::k420);
  EXPECT_TRUE(header.full_range);
  EXPECT_EQ(header.frame_bytes(), 640u * 480 * 3 / 2);
  // 4:2:0 is the default, and the order of parameters is free.
  ASSERT_EQ(open_text("YUV4MPEG2  F25:1 H2 W2\n", &header), Y4mStatus::kOk);
  EXPECT_EQ(header.colour, Y4mColour::k420);
  EXPECT_FALSE(header.full_range);
}

TEST(Y4m, OddSidesRoundChromaUp) {
  Y4mHeader header;
  const auto bytes_with = [&](const std::string& colour) {
    EXPECT_EQ(open_text("YUV4MPEG2 W5 H3 F1:1 C" + colour + "\n", &header), Y4mStatus::kOk);
    return header.frame_bytes();
  };
  EXPECT_EQ(bytes_with("420jpeg"), 15u + 2 * 3 * 2);
  EXPECT_EQ(bytes_with("422"), 15u + 2 * 3 * 3);
  EXPECT_EQ(bytes_with("444"), 45u);
  EXPECT_EQ(bytes_with("mono"), 15u);
}

TEST(Y4m, RejectsBadHeaders) {
  EXPECT_EQ(open_text(""), Y4mStatus::kBadSignature);
  EXPECT_EQ(open_text("RIFF\n"), Y4mStatus::kBadSignature);
  EXPECT_EQ(open_text("YUV4MPEG2W1 H1 F1:1\n"), Y4mStatus::kBadSignature);
  EXPECT_EQ(open_text("YUV4MPEG2 W2 H2 F1:1"), Y4mStatus::kTruncatedHeader);
  EXPECT_EQ(open_text("YUV4MPEG2 W2 H2 F1:1 X" + std::string(2000, 'a') + "\n"),
            Y4mStatus::kHeaderTooLong);
  for (const char* bad : {"W0 H2", "W-2 H2", "W+2 H2", "W H2", "W2", "H2", "", "W2 H16385",
                          "W4294967298 H2", "W99999999999999999999 H2", "W2.0 H2", "W0x2 H2"}) {
    EXPECT_EQ(open_text(std::string("YUV4MPEG2 ") + bad + " F1:1\n"), Y4mStatus::kBadSize) << bad;
  }
  for (const char* bad : {"", "F", "F25", "F25:", "F:1", "F0:0", "F0:1", "F25:0", "F-25:1",
                          "F25:-1", "F25:1:1", "F2147483648:1", "F25,0:1"}) {
    EXPECT_EQ(open_text(std::string("YUV4MPEG2 W2 H2 ") + bad + "\n"), Y4mStatus::kBadRate) << bad;
  }
  for (const char* bad : {"C411", "C420p10", "C444alpha", "Cmono16", "C"}) {
    EXPECT_EQ(open_text(std::string("YUV4MPEG2 W2 H2 F1:1 ") + bad + "\n"),
              Y4mStatus::kUnsupportedColour)
        << bad;
  }
  EXPECT_EQ(open_text("YUV4MPEG2 W2 H2 F1:1 Q7\n"), Y4mStatus::kBadParameter);
}

TEST(Y4m, ReadsFramesToTheEnd) {
  const std::string head = "YUV4MPEG2 W2 H2 F1:1\n";
  int frames = 0;
  EXPECT_EQ(read_all(head, &frames), Y4mStatus::kEnd);
  EXPECT_EQ(frames, 0);
  EXPECT_EQ(read_all(head + "FRAME\nYYYYUVFRAME Ixyz\n\n\n\n\nUV", &frames), Y4mStatus::kEnd);
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(read_all(head + "FRAME\nYYYYU", &frames), Y4mStatus::kTruncatedFrame);
  EXPECT_EQ(read_all(head + "FRAME\nYYYYUVtrash", &frames), Y4mStatus::kBadFrameHeader);
  EXPECT_EQ(frames, 1);
  EXPECT_EQ(read_all(head + "FRAMES\nYYYYUV", &frames), Y4mStatus::kBadFrameHeader);
  EXPECT_EQ(read_all(head + "FRAME " + std::string(3000, 'x'), &frames),
            Y4mStatus::kBadFrameHeader);
  EXPECT_EQ(read_all(head + "\n", &frames), Y4mStatus::kBadFrameHeader);
}

TEST(Y4m, PixelsAreUnchanged) {
  const std::string text = "YUV4MPEG2 W2 H2 F1:1\nFRAME\nabcdef";
  std::span<const std::byte> left = std::as_bytes(std::span(text));
  Y4mReader reader;
  ASSERT_EQ(reader.open(span_source(&left)), Y4mStatus::kOk);
  std::vector<std::byte> frame(reader.header().frame_bytes());
  EXPECT_EQ(reader.read_frame(std::span(frame).first(5)), Y4mStatus::kBufferTooSmall);
  ASSERT_EQ(reader.read_frame(frame), Y4mStatus::kOk);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(frame.data()), frame.size()), "abcdef");
}

TEST(Y4m, TruncatedAtEveryByte) {
  const std::string whole = "YUV4MPEG2 W3 H1 F25:1 C444\nFRAME\n123456789FRAME\n123456789";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    int frames = 0;
    const Y4mStatus status = read_all(whole.substr(0, size), &frames);
    const bool between_frames = status == Y4mStatus::kEnd;
    EXPECT_EQ(between_frames, size == 27 || size == 42) << size;
    EXPECT_LT(frames, 2);
  }
}

TEST(Y4m, ReadsFromAFile) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  std::fputs("YUV4MPEG2 W1 H1 F1:1 Cmono\nFRAME\na", file);
  std::rewind(file);
  Y4mReader reader;
  std::byte pixel{};
  EXPECT_EQ(reader.open(file_source(file)), Y4mStatus::kOk);
  EXPECT_EQ(reader.read_frame({&pixel, 1}), Y4mStatus::kOk);
  EXPECT_EQ(pixel, std::byte{'a'});
  EXPECT_EQ(reader.read_frame({&pixel, 1}), Y4mStatus::kEnd);
  std::fclose(file);
}

TEST(Y4m, EveryStatusHasItsOwnMessage) {
  std::set<std::string> messages;
  for (std::uint8_t i = 0; i < kY4mStatusCount; ++i) {
    messages.insert(message(static_cast<Y4mStatus>(i)));
  }
  EXPECT_EQ(messages.size(), kY4mStatusCount);
  EXPECT_EQ(messages.count("unknown status"), 0u);
}

}  // namespace
}  // namespace mien::formats
