// Converts each sample type to float.
#include "formats/wav_samples.h"

#include <bit>

#include "formats/little_endian.h"

namespace mien::formats {
namespace {

float from_unsigned8(const std::byte* stored) {
  return static_cast<float>(std::to_integer<int>(*stored) - 128) / 0x1p7f;
}

float from_int16(const std::byte* stored) {
  return static_cast<float>(static_cast<std::int16_t>(load_little<std::uint16_t>(stored))) /
         0x1p15f;
}

// Shifts the sample to the upper bytes of 32 bits to extend its sign; fp32 represents 24 bits
// exactly.
float from_int24(const std::byte* stored) {
  const std::uint32_t low = load_little<std::uint16_t>(stored);
  const std::uint32_t bits = low << 8 | std::to_integer<std::uint32_t>(stored[2]) << 24;
  return static_cast<float>(static_cast<std::int32_t>(bits)) / 0x1p31f;
}

float from_int32(const std::byte* stored) {
  return static_cast<float>(static_cast<std::int32_t>(load_little<std::uint32_t>(stored))) /
         0x1p31f;
}

float from_float32(const std::byte* stored) {
  return std::bit_cast<float>(load_little<std::uint32_t>(stored));
}

float from_float64(const std::byte* stored) {
  return static_cast<float>(std::bit_cast<double>(load_little<std::uint64_t>(stored)));
}

template <std::size_t kBytes, float (*kFrom)(const std::byte*)>
void convert(std::span<const std::byte> stored, std::span<float> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = kFrom(&stored[i * kBytes]);
  }
}

}  // namespace

void convert_wav_samples(const WavFormat& format, std::span<const std::byte> stored,
                         std::span<float> samples) {
  if (format.coding == WavCoding::kFloat) {
    return format.bits == 32 ? convert<4, from_float32>(stored, samples)
                             : convert<8, from_float64>(stored, samples);
  }
  switch (format.bits) {
    case 8:
      return convert<1, from_unsigned8>(stored, samples);
    case 16:
      return convert<2, from_int16>(stored, samples);
    case 24:
      return convert<3, from_int24>(stored, samples);
    default:
      return convert<4, from_int32>(stored, samples);
  }
}

}  // namespace mien::formats
