// Element-wise operations on two maps: y = a * b, a / b or a + b.
//
// a, y: [h, w, c]; b: the same, or with a single row, column or channel that repeats_* broadcast.
// In blocks of 8 channels. y may be a. Lanes beyond the channels become 0.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

enum class Combination : std::uint8_t { kProduct, kQuotient, kSum };

struct CombineArgs {
  static constexpr std::string_view kFamily = "combine";
  const float* a;
  const float* b;
  float* y;
  Combination kind;
  std::int32_t h, w, channels;
  bool repeats_rows, repeats_columns, repeats_channels;  // broadcast b
};

}  // namespace mien::kernels
