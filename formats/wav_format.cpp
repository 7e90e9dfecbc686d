// Parses the fmt chunk.
#include <algorithm>
#include <array>
#include <cstring>

#include "formats/little_endian.h"
#include "formats/wav_header.h"

namespace mien::formats {
namespace {

constexpr std::uint16_t kPcmTag = 1;
constexpr std::uint16_t kFloatTag = 3;
constexpr std::uint16_t kExtensibleTag = 0xfffe;

// Byte offsets in WAVEFORMATEX and WAVEFORMATEXTENSIBLE. Bytes per second (8) and the channel mask
// (20) are ignored: many files have wrong values, and the reader does not need them.
constexpr std::size_t kTagAt = 0;
constexpr std::size_t kChannelsAt = 2;
constexpr std::size_t kRateAt = 4;
constexpr std::size_t kBlockAlignAt = 12;
constexpr std::size_t kBitsAt = 14;
constexpr std::uint32_t kBasicBytes = 16;
constexpr std::size_t kExtensionBytesAt = 16;
constexpr std::uint32_t kExtensionBytes = 22;
constexpr std::size_t kValidBitsAt = 18;
constexpr std::size_t kSubFormatAt = 24;

using Body = std::span<const std::byte, kWavFormatBytes>;

std::uint16_t field16(Body body, std::size_t at) {
  return load_little<std::uint16_t>(body.subspan(at, 2).data());
}

// The GUID of a sub-format is a tag followed by this: xxxxxxxx-0000-0010-8000-00AA00389B71.
bool is_tag_guid(Body body) {
  constexpr std::array<std::uint8_t, 14> kRest = {0,    0,    0,    0,    0x10, 0,    0x80,
                                                  0x00, 0x00, 0xaa, 0x00, 0x38, 0x9b, 0x71};
  return std::memcmp(body.data() + kSubFormatAt + 2, kRest.data(), kRest.size()) == 0;
}

WavFault parse_coding(std::uint16_t tag, WavFault otherwise, WavCoding& coding) {
  if (tag != kPcmTag && tag != kFloatTag) {
    return otherwise;
  }
  coding = tag == kPcmTag ? WavCoding::kPcm : WavCoding::kFloat;
  return {};
}

WavFault parse_extension(Body body, std::uint32_t chunk_bytes, WavCoding& coding) {
  if (chunk_bytes < kWavFormatBytes || field16(body, kExtensionBytesAt) < kExtensionBytes) {
    return {WavStatus::kBadExtensionSize, kExtensionBytesAt};
  }
  const WavFault unsupported = {WavStatus::kUnsupportedSubFormat, kSubFormatAt};
  if (!is_tag_guid(body)) {
    return unsupported;
  }
  return parse_coding(field16(body, kSubFormatAt), unsupported, coding);
}

bool bits_allowed(WavCoding coding, std::uint32_t bits) {
  if (coding == WavCoding::kFloat) {
    return bits == 32 || bits == 64;
  }
  return bits == 8 || bits == 16 || bits == 24 || bits == 32;
}

// Checks the numeric fields for a known coding.
WavFault check_fields(Body body, const WavFormat& format) {
  if (format.channels < 1 || format.channels > kMaxWavChannels) {
    return {WavStatus::kBadChannels, kChannelsAt};
  }
  if (format.sample_rate < kMinWavRate || format.sample_rate > kMaxWavRate) {
    return {WavStatus::kBadRate, kRateAt};
  }
  if (!bits_allowed(format.coding, format.bits)) {
    return {WavStatus::kBadBits, kBitsAt};
  }
  if (field16(body, kBlockAlignAt) != format.frame_bytes()) {
    return {WavStatus::kBadBlockAlign, kBlockAlignAt};
  }
  return {};
}

}  // namespace

WavFault parse_wav_format(Body body, std::uint32_t chunk_bytes, WavFormat& format) {
  if (chunk_bytes < kBasicBytes) {
    return {WavStatus::kBadFormatSize, 0};
  }
  const std::uint16_t tag = field16(body, kTagAt);
  const bool extensible = tag == kExtensibleTag;
  const WavFault coding =
      extensible ? parse_extension(body, chunk_bytes, format.coding)
                 : parse_coding(tag, {WavStatus::kUnsupportedCoding, kTagAt}, format.coding);
  if (coding.status != WavStatus::kOk) {
    return coding;
  }
  format.channels = field16(body, kChannelsAt);
  format.sample_rate = load_little<std::uint32_t>(body.subspan(kRateAt, 4).data());
  format.bits = field16(body, kBitsAt);
  const WavFault fields = check_fields(body, format);
  if (fields.status != WavStatus::kOk) {
    return fields;
  }
  // Zero stands for an unspecified number of valid bits.
  if (extensible && field16(body, kValidBitsAt) > format.bits) {
    return {WavStatus::kBadValidBits, kValidBitsAt};
  }
  return {};
}

}  // namespace mien::formats
