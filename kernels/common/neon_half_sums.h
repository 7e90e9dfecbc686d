// Sums of a panel of outputs over a vector of inputs: groups of 8 inputs in half precision, the
// sums of the groups in fp32. Larger groups would save little time and lose accuracy in these
// layers, which produce the visible output.
#pragma once

#include "kernels/common/neon_half.h"

namespace mien::kernels::MIEN_TIER {
namespace {

template <int kVecs>
struct PanelSums {
  static constexpr int kHalfVecs = kVecs / 2;
  Vec sum[kVecs];

  [[gnu::always_inline]] explicit PanelSums(const Half* bias) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) { sum[v] = load_half(bias + v * kLanes); }
  }
  // Even and odd inputs have separate sums, so that two dependency chains hide the latency.
  using Products = HalfVec[2][kHalfVecs];
  template <int kLane>
  [[gnu::always_inline]] static void add_input(HalfVec x, const Half* w, Products& products) {
    HalfVec row[kHalfVecs];
    MIEN_UNROLLED for (int v = 0; v < kHalfVecs; ++v) {
      row[v] = load_halves(w + (kLane * kHalfVecs + v) * kHalves);
    }
    MIEN_UNROLLED for (int v = 0; v < kHalfVecs; ++v) {
      HalfVec& one = products[kLane % 2][v];
      one = kLane < 2 ? multiply_lane<kLane>(row[v], x) : fma_lane<kLane>(one, row[v], x);
    }
  }
  // n must be a multiple of 8. Returns the address of the next weights.
  [[gnu::always_inline]] const Half* add(const float* x, std::int32_t n, const Half* w) {
    for (std::int32_t k = 0; k < n; k += kHalves, w += kHalves * kHalfVecs * kHalves) {
      const HalfVec eight = to_half(load_pair(x + k));
      Products products = {};
      add_input<0>(eight, w, products);
      add_input<1>(eight, w, products);
      add_input<2>(eight, w, products);
      add_input<3>(eight, w, products);
      add_input<4>(eight, w, products);
      add_input<5>(eight, w, products);
      add_input<6>(eight, w, products);
      add_input<7>(eight, w, products);
      MIEN_UNROLLED for (int v = 0; v < kHalfVecs; ++v) {
        const Pair both = widened(finite(vaddq_f16(products[0][v], products[1][v])));
        sum[2 * v] = vaddq_f32(sum[2 * v], both.low);
        sum[2 * v + 1] = vaddq_f32(sum[2 * v + 1], both.high);
      }
    }
    return w;
  }
  [[gnu::always_inline]] void total(Vec (&totals)[1][kVecs]) const {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) { totals[0][v] = sum[v]; }
  }
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
