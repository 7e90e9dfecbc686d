#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

// Shifts right by `shift` (1..24), rounding to nearest, ties to even.
std::uint32_t rounded_shift(std::uint32_t value, std::uint32_t shift) {
  const std::uint32_t half = 1u << (shift - 1);
  const std::uint32_t odd = (value >> shift) & 1u;
  return (value + half - 1 + odd) >> shift;
}

std::uint16_t to_half(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000u;
  const std::uint32_t magnitude = bits & 0x7FFFFFFFu;
  std::uint32_t half = 0;
  if (magnitude > 0x7F800000u) {  // NaN: quiet, with what fits of its payload
    half = 0x7E00u | ((magnitude >> 13) & 0x3FFu);
  } else if (magnitude >= 0x477FF000u) {  // 65520 and above round to infinity
    half = 0x7C00u;
  } else if (magnitude >= 0x38800000u) {  // normal: exponent moves from bias 127 to 15
    half = rounded_shift(magnitude - (112u << 23), 13);
  } else if (magnitude >= 0x33000000u) {  // denormal: multiples of 2^-24
    const std::uint32_t exponent = magnitude >> 23;
    half = rounded_shift((magnitude & 0x7FFFFFu) | 0x800000u, 126 - exponent);
  }
  return static_cast<std::uint16_t>(sign | half);
}

}  // namespace

void half_to_float(const HalfToFloatArgs& a) {
  for (std::int32_t i = 0; i < a.n; ++i) {
    a.y[i] = half_to_float(a.x[i]);
  }
}

void float_to_half(const FloatToHalfArgs& a) {
  for (std::int32_t i = 0; i < a.n; ++i) {
    a.y[i] = to_half(a.x[i]);
  }
}

}  // namespace mien::kernels::ref
