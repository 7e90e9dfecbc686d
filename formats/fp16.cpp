// Half-precision conversion.
#include "formats/fp16.h"

#include <bit>
#include <cmath>

namespace mien::formats {
namespace {

constexpr float kSmallestNormal = 0x1p-14f;
constexpr float kTooLarge = 65520.0f;  // halfway between the largest half and the next power of two

}  // namespace

std::uint16_t fp16_from_float(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000;
  const float magnitude = std::bit_cast<float>(bits & 0x7fffffff);
  if (std::isnan(value)) {
    return static_cast<std::uint16_t>(sign | 0x7e00);
  }
  if (magnitude >= kTooLarge) {
    return static_cast<std::uint16_t>(sign | 0x7c00);
  }
  if (magnitude < kSmallestNormal) {
    // Multiples of 2^-24: the last bit of the sum is 2^-24, so that the addition rounds correctly.
    const float sum = magnitude + 0.5f;
    return static_cast<std::uint16_t>(sign | (std::bit_cast<std::uint32_t>(sum) - 0x3f000000));
  }
  // Changes the bias of the exponent from 127 to 15 and rounds off 13 bits, half to even.
  const std::uint32_t rebiased = (bits & 0x7fffffff) - (112u << 23);
  const std::uint32_t rounded = rebiased + 0xfff + (rebiased >> 13 & 1);
  return static_cast<std::uint16_t>(sign | rounded >> 13);
}

float float_from_fp16(std::uint16_t bits) {
  const std::uint32_t sign = static_cast<std::uint32_t>(bits & 0x8000) << 16;
  const std::uint32_t exponent = bits >> 10 & 0x1f;
  const std::uint32_t fraction = bits & 0x3ff;
  if (exponent == 0) {
    const float magnitude = static_cast<float>(fraction) * 0x1p-24f;
    return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(magnitude));
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + 112;
  return std::bit_cast<float>(sign | wide << 23 | fraction << 13);
}

}  // namespace mien::formats
