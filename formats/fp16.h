// Conversion of IEEE 754 half precision, for writers and tests; kernels have their own.
#pragma once

#include <cstdint>

namespace mien::formats {

// Rounds to nearest even; overflow becomes infinity, NaN stays NaN.
std::uint16_t fp16_from_float(float value);
float float_from_fp16(std::uint16_t bits);

}  // namespace mien::formats
