// IEEE 754 half precision, for writers and tests; kernels have their own conversions.
#pragma once

#include <cstdint>

namespace mien::formats {

// Round to nearest even; too large becomes infinity, NaN stays NaN.
std::uint16_t fp16_from_float(float value);
float float_from_fp16(std::uint16_t bits);

}  // namespace mien::formats
