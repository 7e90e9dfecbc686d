// Creates and reads WAV files for tests.
#include "tests/formats/wav_files.h"

#include <gtest/gtest.h>

#include <bit>

namespace mien::formats {

std::string little(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) {
    text += static_cast<char>(value >> (8 * i) & 0xff);
  }
  return text;
}

std::string wav_chunk(std::string_view name, std::string_view body) {
  std::string text(name);
  text += little(body.size(), 4);
  text += body;
  return text + std::string(body.size() % 2, '\0');
}

std::string fmt_body(const FmtFields& fields) {
  const unsigned frame_bytes = fields.channels * (fields.bits / 8u);
  std::string body = little(fields.sub_format ? 0xfffe : fields.tag, 2);
  body += little(fields.channels, 2);
  body += little(fields.rate, 4);
  body += little(std::uint64_t{fields.rate} * frame_bytes, 4);
  body += little(fields.block_align.value_or(static_cast<std::uint16_t>(frame_bytes)), 2);
  body += little(fields.bits, 2);
  if (fields.sub_format) {
    body += little(fields.extension_bytes, 2);
    body += little(fields.valid_bits.value_or(fields.bits), 2);
    body += little(0, 4);  // channel mask: no speakers
    body += little(*fields.sub_format, 2) + fields.guid_rest;
  }
  return body;
}

std::string riff(std::initializer_list<std::string_view> chunks) {
  std::string body = "WAVE";
  for (const std::string_view chunk : chunks) {
    body += chunk;
  }
  return wav_chunk("RIFF", body);
}

std::string rf64(std::uint64_t riff_bytes, std::uint64_t data_bytes, std::string_view chunks) {
  const std::string sizes =
      little(riff_bytes, 8) + little(data_bytes, 8) + little(0, 8) + little(0, 4);
  std::string text = "RF64" + little(0xffffffff, 4) + "WAVE" + wav_chunk("ds64", sizes);
  return text += chunks;
}

std::string simple(const FmtFields& fields, std::string_view data) {
  return riff({wav_chunk("fmt ", fmt_body(fields)), wav_chunk("data", data)});
}

Decoded decode(const std::string& file, const std::function<std::size_t()>& block_frames) {
  // In memory of exact size, so that the address sanitizer detects every read beyond it.
  const std::vector<char> exact(file.begin(), file.end());
  std::span<const std::byte> left = std::as_bytes(std::span(exact));
  WavReader reader;
  Decoded decoded;
  decoded.opened = reader.open(span_source(&left));
  decoded.format = reader.format();
  decoded.fault_offset = reader.fault_offset();
  std::size_t frames = 0;
  if (decoded.opened != WavStatus::kOk) {
    EXPECT_EQ(decoded.format.channels, 0u);
    EXPECT_EQ(decoded.format.sample_rate, 0u);
    EXPECT_EQ(reader.read({}, frames), WavStatus::kEnd);
    EXPECT_LE(decoded.fault_offset, file.size());
    return decoded;
  }
  const std::size_t channels = decoded.format.channels;
  for (;;) {
    std::vector<float> block(block_frames() * channels);
    decoded.ended = reader.read(block, frames);
    EXPECT_EQ(decoded.ended == WavStatus::kOk, frames > 0);
    if (decoded.ended != WavStatus::kOk) {
      break;
    }
    for (const float sample : std::span(block).first(frames * channels)) {
      decoded.samples.push_back(std::bit_cast<std::uint32_t>(sample));
    }
  }
  decoded.fault_offset = reader.fault_offset();
  EXPECT_LE(decoded.fault_offset, file.size());
  std::vector<float> frame(channels);
  EXPECT_EQ(reader.read(frame, frames), decoded.ended) << "the end is permanent";
  EXPECT_EQ(frames, 0u);
  return decoded;
}

Decoded decode(const std::string& file) {
  return decode(file, [] { return std::size_t{1000}; });
}

void expect_refused(const std::string& file, WavStatus status, std::uint64_t offset) {
  const Decoded decoded = decode(file);
  EXPECT_STREQ(message(decoded.opened), message(status));
  EXPECT_EQ(decoded.fault_offset, offset) << message(status);
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& samples) {
  std::vector<std::uint32_t> bits;
  bits.reserve(samples.size());
  for (const float sample : samples) {
    bits.push_back(std::bit_cast<std::uint32_t>(sample));
  }
  return bits;
}

}  // namespace mien::formats
