// Sums of a panel of outputs over a vector of inputs.
#pragma once

#include "kernels/common/neon_weights.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Eight independent sums hide the latency of multiply-adds.
template <int kVecs>
struct PanelSums {
  static constexpr int kParts = 8 / kVecs;
  Vec sum[kParts][kVecs];

  [[gnu::always_inline]] explicit PanelSums(const std::uint16_t* bias) {
    MIEN_UNROLLED for (int i = 0; i < kParts * kVecs; ++i) {
      sum[i / kVecs][i % kVecs] = i < kVecs ? load_half(bias + i * kLanes) : splat(0.0f);
    }
  }
  template <int kLane>
  [[gnu::always_inline]] void add_input(Vec x, const std::uint16_t* w) {
    Vec row[kVecs];
    load_row(w + kLane * kVecs * kLanes, row);
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      Vec& one = sum[kLane % kParts][v];
      one = fma_lane<kLane>(one, row[v], x);
    }
  }
  // n must be a multiple of 4. Returns the address of the next weights.
  [[gnu::always_inline]] const std::uint16_t* add(const float* x, std::int32_t n,
                                                  const std::uint16_t* w) {
    constexpr std::ptrdiff_t kFourRows = std::ptrdiff_t{kLanes} * kVecs * kLanes;
    for (std::int32_t k = 0; k < n; k += kLanes, w += kFourRows) {
      const Vec four = vld1q_f32(x + k);
      add_input<0>(four, w);
      add_input<1>(four, w);
      add_input<2>(four, w);
      add_input<3>(four, w);
    }
    return w;
  }
  [[gnu::always_inline]] void total(Vec (&totals)[1][kVecs]) const {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      totals[0][v] = sum[0][v];
      MIEN_UNROLLED for (int part = 1; part < kParts; ++part) {
        totals[0][v] = vaddq_f32(totals[0][v], sum[part][v]);
      }
    }
  }
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
