// Tests of WAV chunks.
#include "formats/wav.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>

#include "tests/formats/wav_files.h"

namespace mien::formats {
namespace {

// The offset of a field in simple() files.
constexpr std::uint64_t kFmtAt = 12;
constexpr std::uint64_t kFmtBodyAt = 20;

template <typename Number>
struct Boundary {
  Number value;
  bool allowed;
};

// Opens files that differ in one field.
template <typename Number, typename Set>
void expect_boundaries(std::initializer_list<Boundary<Number>> table, WavStatus refusal,
                       std::uint64_t field_at, Set set) {
  for (const auto& [value, allowed] : table) {
    SCOPED_TRACE(value);
    FmtFields fields;
    set(fields, value);
    const std::string file = simple(fields, std::string(64, 'x'));
    if (allowed) {
      EXPECT_STREQ(message(decode(file).opened), "ok");
    } else {
      expect_refused(file, refusal, kFmtBodyAt + field_at);
    }
  }
}

TEST(WavChunks, BoundariesOfTheFields) {
  using U16 = std::uint16_t;
  expect_boundaries<U16>({{0, false}, {1, true}, {2, false}, {4, false}, {0xffff, false}},
                         WavStatus::kUnsupportedCoding, 0,
                         [](FmtFields& fields, U16 tag) { fields.tag = tag; });
  expect_boundaries<U16>(
      {{0, false}, {1, true}, {8, true}, {9, false}, {0x8000, false}, {0xffff, false}},
      WavStatus::kBadChannels, 2, [](FmtFields& fields, U16 value) { fields.channels = value; });
  expect_boundaries<std::uint32_t>(
      {{0, false},
       {7999, false},
       {8000, true},
       {192000, true},
       {192001, false},
       {0x80000000, false},
       {0xffffffff, false}},
      WavStatus::kBadRate, 4, [](FmtFields& fields, std::uint32_t rate) { fields.rate = rate; });
  expect_boundaries<U16>({{0, false},
                          {1, false},
                          {7, false},
                          {8, true},
                          {12, false},
                          {16, true},
                          {20, false},
                          {24, true},
                          {32, true},
                          {33, false},
                          {40, false},
                          {64, false},
                          {0xffff, false}},
                         WavStatus::kBadBits, 14,
                         [](FmtFields& fields, U16 bits) { fields.bits = bits; });
  expect_boundaries<U16>(
      {{8, false}, {16, false}, {24, false}, {31, false}, {32, true}, {64, true}, {80, false}},
      WavStatus::kBadBits, 14, [](FmtFields& fields, U16 bits) {
        fields.tag = 3;
        fields.bits = bits;
      });
  expect_boundaries<U16>(
      {{0, false}, {1, false}, {5, false}, {6, true}, {7, false}, {0xffff, false}},
      WavStatus::kBadBlockAlign, 12, [](FmtFields& fields, U16 align) {
        fields.channels = 3;
        fields.block_align = align;
      });
}

TEST(WavChunks, BoundariesOfTheExtension) {
  using U16 = std::uint16_t;
  expect_boundaries<U16>(
      {{0, true}, {1, true}, {20, true}, {24, true}, {25, false}, {0xffff, false}},
      WavStatus::kBadValidBits, 18, [](FmtFields& fields, U16 valid) {
        fields.bits = 24;
        fields.sub_format = 1;
        fields.valid_bits = valid;
      });
  expect_boundaries<U16>({{0, false}, {21, false}, {22, true}, {23, true}},
                         WavStatus::kBadExtensionSize, 16, [](FmtFields& fields, U16 bytes) {
                           fields.sub_format = 1;
                           fields.extension_bytes = bytes;
                         });
  expect_boundaries<U16>({{0, false}, {1, true}, {2, false}, {0xfffe, false}},
                         WavStatus::kUnsupportedSubFormat, 24,
                         [](FmtFields& fields, U16 sub) { fields.sub_format = sub; });
  for (std::size_t i = 0; i < 14; ++i) {
    FmtFields fields;
    fields.sub_format = 1;
    fields.guid_rest[i] = static_cast<char>(fields.guid_rest[i] ^ 1);
    expect_refused(simple(fields, ""), WavStatus::kUnsupportedSubFormat, kFmtBodyAt + 24);
  }
}

TEST(WavChunks, SizesOfTheFmtChunk) {
  FmtFields fields;
  const std::string plain = fmt_body(fields);
  fields.sub_format = 1;
  const std::string extended = fmt_body(fields);
  const std::string data = wav_chunk("data", "abcd");
  for (std::size_t size = 0; size <= plain.size(); ++size) {
    const std::string file = riff({wav_chunk("fmt ", plain.substr(0, size)), data});
    if (size < 16) {
      expect_refused(file, WavStatus::kBadFormatSize, kFmtBodyAt);
    } else {
      EXPECT_EQ(decode(file).samples.size(), 2u);
    }
  }
  for (std::size_t size = 16; size <= extended.size(); ++size) {
    const std::string file = riff({wav_chunk("fmt ", extended.substr(0, size)), data});
    if (size < 40) {
      expect_refused(file, WavStatus::kBadExtensionSize, kFmtBodyAt + 16);
    } else {
      EXPECT_EQ(decode(file).samples.size(), 2u);
    }
  }
  for (const std::size_t more : {1u, 2u, 3u, 25u, 5000u}) {
    for (const std::string& body : {plain, extended}) {
      const std::string longer = wav_chunk("fmt ", std::string(body).append(more, 'x'));
      EXPECT_EQ(decode(riff({longer, data})).samples.size(), 2u);
    }
  }
}

TEST(WavChunks, StartOfTheFile) {
  expect_refused("", WavStatus::kBadSignature, 0);
  expect_refused("RIF", WavStatus::kBadSignature, 0);
  expect_refused("RIFX" + little(4, 4) + "WAVE", WavStatus::kBadSignature, 0);
  expect_refused("riff" + little(4, 4) + "WAVE", WavStatus::kBadSignature, 0);
  expect_refused("RIFF" + little(4, 4) + "AVI ", WavStatus::kNotWave, 8);
  expect_refused("RIFF" + little(4, 4) + "WAV", WavStatus::kTruncatedHeader, 11);
  expect_refused("RIFF" + little(4, 4) + "WAVE", WavStatus::kNoFormat, 12);
}

TEST(WavChunks, OrderOfChunks) {
  const std::string fmt = wav_chunk("fmt ", fmt_body({}));
  const std::string data = wav_chunk("data", "abcd");
  const auto after_fmt = kFmtAt + fmt.size();
  expect_refused(riff({data}), WavStatus::kDataBeforeFormat, 12);
  expect_refused(riff({data, fmt}), WavStatus::kDataBeforeFormat, 12);
  expect_refused(riff({wav_chunk("JUNK", "xyz"), data, fmt}), WavStatus::kDataBeforeFormat, 24);
  expect_refused(riff({fmt}), WavStatus::kNoData, after_fmt);
  expect_refused(riff({fmt, fmt, data}), WavStatus::kSecondFormat, after_fmt);
  expect_refused(riff({fmt, wav_chunk("fact", "abcd"), fmt, data}), WavStatus::kSecondFormat,
                 after_fmt + 12);
  expect_refused(riff({wav_chunk("LIST", fmt + data)}), WavStatus::kNoFormat, 12 + 8 + 36);
  // Only the first data chunk is read.
  for (const std::string& behind : {data, fmt, wav_chunk("LIST", "odd"), std::string("trash")}) {
    const Decoded decoded = decode(riff({fmt, data, behind}));
    EXPECT_EQ(decoded.ended, WavStatus::kEnd);
    EXPECT_EQ(decoded.samples.size(), 2u);
  }
}

TEST(WavChunks, SkipsOtherChunks) {
  const std::string fmt = wav_chunk("fmt ", fmt_body({}));
  const std::string data = wav_chunk("data", "abcd");
  const auto expected = decode(riff({fmt, data})).samples;
  for (const char* name : {"LIST", "bext", "fact", "smpl", "JUNK", "PEAK", "FMT ", "ds64"}) {
    for (const std::size_t size : {0u, 1u, 2u, 3u, 4095u, 4096u, 4097u, 20001u}) {
      const std::string other = wav_chunk(name, std::string(size, 'd'));
      EXPECT_EQ(decode(riff({other, fmt, other, other, data})).samples, expected);
    }
  }
  for (const std::uint32_t size : {5u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu}) {
    const std::string file = riff({fmt, "LIST", little(size, 4), "abcd"});
    expect_refused(file, WavStatus::kTruncatedHeader, file.size());
    const std::string huge_fmt = riff({"fmt ", little(size, 4), fmt_body({}), data});
    EXPECT_NE(decode(huge_fmt).opened, WavStatus::kOk);
  }
}

}  // namespace
}  // namespace mien::formats
