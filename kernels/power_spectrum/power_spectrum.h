// Power spectrum of a real signal: y_k = |sum_j x_j e^(-2 pi i j k / n)|^2 for k = 0 .. n/2.
//
// x: [n]; y: [n/2 + 1], not overlapping; n a power of two, 128..1024.
// twiddles: [n, 2], cos(2 pi j / n) and -sin(2 pi j / n).
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct PowerSpectrumArgs {
  static constexpr std::string_view kFamily = "power_spectrum";
  static constexpr std::int32_t kMinSize = 128;
  static constexpr std::int32_t kMaxSize = 1024;
  const float* x;
  const float* twiddles;
  float* y;
  std::int32_t n;
};

}  // namespace mien::kernels
