// Two maps element by element: y = a * b, a / b or a + b.
//
// a, y: [h, w, c], b: as they are, but of one row, one column or one channel where repeats_* say
// so; in blocks of 8 channels. y may be a. Lanes beyond the channels become zero.
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
  bool repeats_rows, repeats_columns, repeats_channels;  // of b
};

}  // namespace mien::kernels
