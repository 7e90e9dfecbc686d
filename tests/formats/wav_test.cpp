// Tests of WAV samples.
#include "formats/wav.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/formats/wav_files.h"

namespace mien::formats {
namespace {

// A stored sample and the float it represents.
struct Stored {
  std::string bytes;
  float value;
};

Stored pcm(int bits, std::int64_t value) {
  const auto stored = static_cast<std::uint64_t>(bits == 8 ? value + 128 : value);
  return {little(stored, static_cast<std::size_t>(bits) / 8),
          static_cast<float>(std::ldexp(static_cast<double>(value), 1 - bits))};
}

Stored any_sample(WavCoding coding, int bits, std::mt19937_64& random) {
  if (coding == WavCoding::kPcm) {
    const auto value = static_cast<std::int64_t>(random()) >> (64 - bits);
    return pcm(bits, value);
  }
  if (bits == 32) {
    const auto value = static_cast<std::uint32_t>(random());  // including NaNs and infinities
    return {little(value, 4), std::bit_cast<float>(value)};
  }
  const double value = std::uniform_real_distribution<double>(-2, 2)(random);
  return {little(std::bit_cast<std::uint64_t>(value), 8), static_cast<float>(value)};
}

struct Kind {
  WavCoding coding;
  std::uint16_t bits;
};
constexpr Kind kKinds[] = {{WavCoding::kPcm, 8},  {WavCoding::kPcm, 16},   {WavCoding::kPcm, 24},
                           {WavCoding::kPcm, 32}, {WavCoding::kFloat, 32}, {WavCoding::kFloat, 64}};

TEST(Wav, EveryFormatRoundTrips) {
  std::mt19937_64 random(1);
  for (const Kind kind : kKinds) {
    for (std::uint16_t channels = 1; channels <= kMaxWavChannels; ++channels) {
      for (const bool extensible : {false, true}) {
        FmtFields fields;
        fields.tag = kind.coding == WavCoding::kPcm ? 1 : 3;
        fields.channels = channels;
        fields.bits = kind.bits;
        if (extensible) {
          fields.sub_format = fields.tag;
        }
        std::string data;
        std::vector<float> expected;
        for (int i = 0; i < 3001 * channels; ++i) {
          const Stored sample = any_sample(kind.coding, kind.bits, random);
          data += sample.bytes;
          expected.push_back(sample.value);
        }
        const Decoded decoded = decode(simple(fields, data));
        ASSERT_EQ(decoded.opened, WavStatus::kOk) << message(decoded.opened);
        EXPECT_EQ(decoded.ended, WavStatus::kEnd);
        EXPECT_EQ(decoded.format.sample_rate, 16000u);
        EXPECT_EQ(decoded.format.channels, channels);
        EXPECT_EQ(decoded.format.bits, kind.bits);
        EXPECT_EQ(decoded.format.coding, kind.coding);
        EXPECT_EQ(decoded.format.frames, std::optional<std::uint64_t>(3001));
        EXPECT_TRUE(decoded.samples == bits_of(expected))
            << kind.bits << " bits, " << channels << " channels";
      }
    }
  }
}

TEST(Wav, PcmExtremesAreExact) {
  const auto values = [](std::uint16_t bits, const std::string& data) {
    FmtFields fields;
    fields.bits = bits;
    return decode(simple(fields, data)).samples;
  };
  EXPECT_EQ(values(8, std::string("\x00\x7f\x80\xff", 4)),
            bits_of({-1.0f, -1.0f / 128, 0.0f, 127.0f / 128}));
  EXPECT_EQ(values(16, little(0x8000, 2) + little(0xffff, 2) + little(0, 2) + little(0x7fff, 2)),
            bits_of({-1.0f, -1.0f / 32768, 0.0f, 32767.0f / 32768}));
  EXPECT_EQ(
      values(24, little(0x800000, 3) + little(0xffffff, 3) + little(1, 3) + little(0x7fffff, 3)),
      bits_of({-1.0f, -0x1p-23f, 0x1p-23f, 8388607.0f / 8388608}));
  EXPECT_EQ(values(32, little(0x80000000, 4) + little(0xffffffff, 4) + little(0x7fffff80, 4) +
                           little(0x7fffffff, 4)),
            bits_of({-1.0f, -0x1p-31f, 1.0f - 0x1p-24f, 1.0f}));
}

TEST(Wav, FloatsAreUnchanged) {
  FmtFields fields;
  fields.tag = 3;
  fields.bits = 32;
  // Quiet and signalling NaN, infinities, -0, the smallest number, values far above full scale.
  const std::vector<std::uint32_t> patterns = {0x7fc00001, 0x7f800001, 0xff800000, 0x7f800000,
                                               0x80000000, 0x00000001, 0x7f7fffff};
  std::string data;
  for (const std::uint32_t pattern : patterns) {
    data += little(pattern, 4);
  }
  EXPECT_EQ(decode(simple(fields, data)).samples, patterns);
  fields.bits = 64;
  data.clear();
  for (const double value : {0.1, 1e300, -1e300, 1e-300, std::numeric_limits<double>::infinity()}) {
    data += little(std::bit_cast<std::uint64_t>(value), 8);
  }
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(decode(simple(fields, data)).samples,
            bits_of({0.1f, infinity, -infinity, 0.0f, infinity}));
  data = little(std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN()), 8);
  EXPECT_TRUE(std::isnan(std::bit_cast<float>(decode(simple(fields, data)).samples.at(0))));
}

TEST(Wav, ValidBitsAreTheUpperOnes) {
  FmtFields fields;
  fields.bits = 32;
  fields.sub_format = 1;
  fields.valid_bits = 24;
  EXPECT_EQ(decode(simple(fields, little(0x40000000, 4))).samples, bits_of({0.5f}));
}

// Chunks of even and odd size around 7 stereo frames.
std::string golden() {
  FmtFields fields;
  fields.channels = 2;
  return riff({wav_chunk("LIST", "INFOISFT odd"), wav_chunk("bext", "odd"),
               wav_chunk("fmt ", fmt_body(fields) + little(0, 2)), wav_chunk("fact", little(7, 4)),
               wav_chunk("data", "aabbccddeeffgghhiijjkkllmmnn")});
}

TEST(Wav, TruncatedAtEveryByte) {
  const std::string whole = golden();
  const std::size_t data_at = whole.find("data") + 8;
  const Decoded all = decode(whole);
  ASSERT_EQ(all.samples.size(), 14u);
  EXPECT_EQ(all.ended, WavStatus::kEnd);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Decoded decoded = decode(whole.substr(0, size));
    EXPECT_EQ(decoded.opened == WavStatus::kOk, size >= data_at) << size;
    if (size < 4) {
      EXPECT_EQ(decoded.opened, WavStatus::kBadSignature) << size;
    } else {
      EXPECT_EQ(decoded.fault_offset, size);
    }
    if (size < data_at) {
      continue;
    }
    EXPECT_EQ(decoded.ended, WavStatus::kTruncatedData) << size;
    EXPECT_EQ(decoded.samples.size(), (size - data_at) / 4 * 2) << size;
    EXPECT_TRUE(std::equal(decoded.samples.begin(), decoded.samples.end(), all.samples.begin()));
  }
}

TEST(Wav, BlockSizesDoNotMatter) {
  FmtFields fields;
  fields.channels = 3;
  fields.bits = 24;
  std::mt19937 random(2);
  std::string data(9 * 5000 + 4, '\0');  // ends inside a frame
  std::ranges::generate(data, [&] { return static_cast<char>(random()); });
  const std::string file = simple(fields, data);
  const Decoded whole = decode(file, [] { return std::size_t{6000}; });
  ASSERT_EQ(whole.samples.size(), 15000u);
  const auto expect_same = [&](const Decoded& decoded) {
    EXPECT_TRUE(decoded.samples == whole.samples);
    EXPECT_EQ(decoded.ended, WavStatus::kPartialFrame);
    EXPECT_EQ(decoded.fault_offset, whole.fault_offset);
  };
  expect_same(decode(file, [] { return std::size_t{1}; }));
  expect_same(decode(file, [] { return std::size_t{5000}; }));
  for (int i = 0; i < 20; ++i) {
    expect_same(decode(file, [&] { return 1 + random() % 700; }));
  }
}

TEST(Wav, SpaceForPartOfAFrameStaysUnused) {
  std::span<const std::byte> left;
  const std::string file = golden();
  left = std::as_bytes(std::span(file));
  WavReader reader;
  ASSERT_EQ(reader.open(span_source(&left)), WavStatus::kOk);
  std::size_t frames = 7;
  std::vector<float> samples(5, 9.0f);
  EXPECT_EQ(reader.read({}, frames), WavStatus::kBufferTooSmall);
  EXPECT_EQ(frames, 0u);
  EXPECT_EQ(reader.read(std::span(samples).first(1), frames), WavStatus::kBufferTooSmall);
  ASSERT_EQ(reader.read(samples, frames), WavStatus::kOk);
  EXPECT_EQ(frames, 2u);
  EXPECT_NE(samples[3], 9.0f);
  EXPECT_EQ(samples[4], 9.0f);
}

TEST(Wav, DoesNotReadBeyondTheSamples) {
  const std::string file = simple({}, "abcd") + "behind";
  std::span<const std::byte> left = std::as_bytes(std::span(file));
  WavReader reader;
  ASSERT_EQ(reader.open(span_source(&left)), WavStatus::kOk);
  std::vector<float> samples(100);
  std::size_t frames = 0;
  EXPECT_EQ(reader.read(samples, frames), WavStatus::kOk);
  EXPECT_EQ(reader.read(samples, frames), WavStatus::kEnd);
  EXPECT_EQ(left.size(), std::strlen("behind"));
}

TEST(Wav, ReadsFromAFile) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  const std::string bytes = golden();
  std::fwrite(bytes.data(), 1, bytes.size(), file);
  std::rewind(file);
  WavReader reader;
  ASSERT_EQ(reader.open(file_source(file)), WavStatus::kOk);
  std::vector<float> samples(20);
  std::size_t frames = 0;
  EXPECT_EQ(reader.read(samples, frames), WavStatus::kOk);
  EXPECT_EQ(frames, 7u);
  EXPECT_EQ(reader.read(samples, frames), WavStatus::kEnd);
  std::fclose(file);
}

TEST(Wav, AReaderCanBeReopened) {
  WavReader reader;
  std::size_t frames = 0;
  std::vector<float> samples(20);
  EXPECT_EQ(reader.read(samples, frames), WavStatus::kEnd) << "never opened";
  const std::string file = golden();
  for (int i = 0; i < 2; ++i) {
    std::span<const std::byte> left = std::as_bytes(std::span(file));
    ASSERT_EQ(reader.open(span_source(&left)), WavStatus::kOk);
    EXPECT_EQ(reader.read(samples, frames), WavStatus::kOk);
    EXPECT_EQ(frames, 7u);
    EXPECT_EQ(reader.open(span_source(&left)), WavStatus::kBadSignature);
    EXPECT_EQ(reader.read(samples, frames), WavStatus::kEnd);
  }
}

TEST(Wav, EveryStatusHasItsOwnMessage) {
  std::set<std::string> messages;
  for (std::uint8_t i = 0; i < kWavStatusCount; ++i) {
    messages.insert(message(static_cast<WavStatus>(i)));
  }
  EXPECT_EQ(messages.size(), kWavStatusCount);
  EXPECT_EQ(messages.count("unknown status"), 0u);
}

}  // namespace
}  // namespace mien::formats
