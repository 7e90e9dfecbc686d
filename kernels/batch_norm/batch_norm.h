// Batch normalisation (Ioffe & Szegedy 2015) as it stands before folding:
//   y = (x - mean[c]) / sqrt(variance[c] + epsilon) * gain[c] + offset[c]
//
// x, y: [pixels, c] in blocks of 8 channels; y may be x. Lanes >= c become 0. Weight files hold
// folded convolutions only; this exists to test the folding.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct BatchNormArgs {
  static constexpr std::string_view kFamily = "batch_norm";
  const float* x;
  float* y;
  const float *mean, *variance, *gain, *offset;  // [c]
  float epsilon;
  std::int32_t pixels;
  std::int32_t channels;
};

}  // namespace mien::kernels
