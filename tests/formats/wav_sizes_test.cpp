// Tests of sizes in WAV files.
#include "formats/wav.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>

#include "tests/formats/wav_files.h"

namespace mien::formats {
namespace {

// simple() with these sizes.
std::string with_sizes(std::uint32_t riff_bytes, std::uint32_t data_bytes,
                       const std::string& data) {
  return "RIFF" + little(riff_bytes, 4) + "WAVE" + wav_chunk("fmt ", fmt_body({})) + "data" +
         little(data_bytes, 4) + data;
}

TEST(WavSizes, UnknownSizesExtendToTheEnd) {
  const std::string data(30000, 'x');
  constexpr std::uint32_t kUnknown = 0xffffffff;
  // 36 bytes before the body of the data chunk count to the size of the RIFF chunk.
  for (const std::uint32_t riff_bytes : {0u, 8u, 36u, kUnknown}) {
    for (const std::uint32_t data_bytes : {0u, 0x7ffff000u, 0x7fffff00u, kUnknown}) {
      const Decoded decoded = decode(with_sizes(riff_bytes, data_bytes, data));
      EXPECT_EQ(decoded.format.frames, std::nullopt);
      EXPECT_EQ(decoded.samples.size(), 15000u) << riff_bytes << ' ' << data_bytes;
      EXPECT_EQ(decoded.ended, WavStatus::kEnd);
      const Decoded odd = decode(with_sizes(riff_bytes, data_bytes, data + "x"));
      EXPECT_EQ(odd.samples.size(), 15000u);
      EXPECT_EQ(odd.ended, WavStatus::kPartialFrame);
      EXPECT_EQ(odd.fault_offset, 44u + 30000);
      EXPECT_TRUE(decode(with_sizes(riff_bytes, data_bytes, "")).samples.empty());
    }
  }
  EXPECT_EQ(decode(with_sizes(36 + 30000, kUnknown, data)).samples.size(), 15000u);
}

TEST(WavSizes, PlaceholderSizesAreRoundedToFrames) {
  FmtFields stereo24;
  stereo24.channels = 2;
  stereo24.bits = 24;
  for (const std::uint32_t size : {0x7fffeffcu, 0x7ffff000u}) {
    const Decoded decoded =
        decode("RIFF" + little(0x7ffff024, 4) + "WAVE" + wav_chunk("fmt ", fmt_body(stereo24)) +
               "data" + little(size, 4) + std::string(600, 'x'));
    EXPECT_EQ(decoded.ended, WavStatus::kEnd) << size;
    EXPECT_EQ(decoded.samples.size(), 200u);
  }
}

TEST(WavSizes, AChunkMayBeEmpty) {
  const Decoded decoded = decode(with_sizes(36 + 12, 0, wav_chunk("LIST", "abcd")));
  EXPECT_EQ(decoded.opened, WavStatus::kOk);
  EXPECT_EQ(decoded.format.frames, std::optional<std::uint64_t>(0));
  EXPECT_EQ(decoded.ended, WavStatus::kEnd);
  EXPECT_TRUE(decoded.samples.empty());
  EXPECT_TRUE(decode(with_sizes(37, 0, "abcd")).samples.empty()) << "one byte says so";
}

TEST(WavSizes, TheSizeOfTheRiffChunkIsIgnored) {
  for (const std::uint32_t size : {0u, 1u, 4u, 40u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
    const Decoded decoded = decode(with_sizes(size, 4, "abcdefgh"));
    EXPECT_EQ(decoded.samples.size(), 2u) << size;
    EXPECT_EQ(decoded.ended, WavStatus::kEnd);
  }
}

TEST(WavSizes, SizesOfTheDataChunk) {
  struct Case {
    std::uint32_t declared;
    std::size_t frames;
    WavStatus ended;
    std::uint64_t fault_offset;
  };
  // The data have 9 bytes, with samples of 2 bytes.
  for (const Case& c :
       {Case{1, 0, WavStatus::kPartialFrame, 44}, Case{2, 1, WavStatus::kEnd, 46},
        Case{3, 1, WavStatus::kPartialFrame, 46}, Case{8, 4, WavStatus::kEnd, 52},
        Case{9, 4, WavStatus::kPartialFrame, 52}, Case{10, 4, WavStatus::kTruncatedData, 53},
        Case{0x7fffffff, 4, WavStatus::kTruncatedData, 53},
        Case{0x80000000, 4, WavStatus::kTruncatedData, 53},
        Case{0xfffffffe, 4, WavStatus::kTruncatedData, 53}}) {
    const Decoded decoded = decode(with_sizes(100, c.declared, "123456789"));
    EXPECT_EQ(decoded.format.frames, std::optional<std::uint64_t>(c.declared / 2));
    EXPECT_EQ(decoded.samples.size(), c.frames) << c.declared;
    EXPECT_STREQ(message(decoded.ended), message(c.ended)) << c.declared;
    EXPECT_EQ(decoded.fault_offset, c.fault_offset) << c.declared;
  }
}

TEST(WavSizes, ReadsTheSizesOfRf64) {
  const std::string fmt = wav_chunk("fmt ", fmt_body({}));
  const std::string data = "data" + little(0xffffffff, 4) + "abcdef";
  Decoded decoded = decode(rf64(1000, 4, fmt + data));
  EXPECT_EQ(decoded.samples.size(), 2u);
  EXPECT_EQ(decoded.ended, WavStatus::kEnd);
  // A valid 32-bit size is used.
  decoded = decode(rf64(1000, 4, fmt + wav_chunk("data", "abcdef")));
  EXPECT_EQ(decoded.samples.size(), 3u);
  for (const std::uint64_t size :
       {std::uint64_t{0x100000000}, UINT64_MAX - 1, UINT64_MAX / 2 + 1}) {
    decoded = decode(rf64(UINT64_MAX - 1, size, fmt + data));
    EXPECT_EQ(decoded.format.frames, std::optional(size / 2));
    EXPECT_EQ(decoded.samples.size(), 3u);
    EXPECT_EQ(decoded.ended, WavStatus::kTruncatedData);
  }
  for (const std::uint64_t size : {std::uint64_t{0}, UINT64_MAX}) {
    for (const std::uint64_t riff_bytes : {std::uint64_t{0}, UINT64_MAX}) {
      decoded = decode(rf64(riff_bytes, size, fmt + data));
      EXPECT_EQ(decoded.format.frames, std::nullopt);
      EXPECT_EQ(decoded.samples.size(), 3u);
      EXPECT_EQ(decoded.ended, WavStatus::kEnd);
    }
  }
  std::string broadcast = rf64(1000, 4, fmt + data);
  broadcast.replace(0, 2, "BW");
  EXPECT_EQ(decode(broadcast).samples.size(), 2u);
}

TEST(WavSizes, RejectsBadSizesOfRf64) {
  const std::string start = "RF64" + little(0xffffffff, 4) + "WAVE";
  const std::string rest = wav_chunk("fmt ", fmt_body({})) + wav_chunk("data", "abcd");
  expect_refused(start + rest, WavStatus::kBadSizes64, 12);
  expect_refused(start + wav_chunk("JUNK", std::string(28, 'x')) + rest, WavStatus::kBadSizes64,
                 12);
  for (std::size_t size = 0; size < 28; ++size) {
    std::string file = start;
    file.append(wav_chunk("ds64", std::string(size, '\0'))).append(rest);
    expect_refused(file, WavStatus::kBadSizes64, 12);
  }
  expect_refused(start + "ds64" + little(28, 4) + std::string(27, '\0'),
                 WavStatus::kTruncatedHeader, 12 + 8 + 27);
  // With a table of sizes of other chunks, which is skipped.
  const std::string table =
      little(0, 8) + little(4, 8) + little(0, 8) + little(1, 4) + "axml" + little(0x100000000, 8);
  EXPECT_EQ(decode(start + wav_chunk("ds64", table) + rest).samples.size(), 2u);
}

TEST(WavSizes, SurvivesAnyHeaderByte) {
  FmtFields fields;
  fields.sub_format = 1;
  fields.bits = 8;
  const std::string chunks = wav_chunk("fmt ", fmt_body(fields)) + wav_chunk("data", "123456789");
  for (const std::string& file : {riff({chunks}), rf64(1000, 4, chunks)}) {
    for (std::size_t at = 0; at < file.size(); ++at) {
      for (int value = 0; value < 256; ++value) {
        std::string spoilt = file;
        spoilt[at] = static_cast<char>(value);
        EXPECT_LE(decode(spoilt).samples.size(), 10u);
      }
    }
  }
}

}  // namespace
}  // namespace mien::formats
