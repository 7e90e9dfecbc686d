// Matrix times vector on packed panels: fully connected layers, causal convolutions, LSTM gates.
#pragma once

#include "kernels/common/neon_activation.h"
#include "kernels/common/neon_weights.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Eight independent sums hide the latency of multiply-adds.
template <int kVecs>
struct PanelSums {
  static constexpr int kParts = 8 / kVecs;
  Vec sum[kParts][kVecs];

  template <int kLane>
  [[gnu::always_inline]] void add_input(Vec x, const std::uint16_t* w) {
    Vec row[kVecs];
    load_row(w + kLane * kVecs * kLanes, row);
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      Vec& one = sum[kLane % kParts][v];
      one = fma_lane<kLane>(one, row[v], x);
    }
  }
  // n is a multiple of 4. Returns the weights that follow.
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

struct TwoParts {
  const float* first;
  std::int32_t first_elems;
  const float* second;
  std::int32_t second_elems;
};

// kVecs vectors of outputs.
template <int kVecs>
[[gnu::noinline]] void matvec_panel(const TwoParts& x, const std::uint16_t* weights,
                                    const std::uint16_t* bias, const Activator& activator,
                                    std::int32_t first, float* y) {
  PanelSums<kVecs> sums;
  MIEN_UNROLLED for (int i = 0; i < PanelSums<kVecs>::kParts * kVecs; ++i) {
    sums.sum[i / kVecs][i % kVecs] = i < kVecs ? load_half(bias + first + i * kLanes) : splat(0.0f);
  }
  weights = sums.add(x.first, x.first_elems, weights);
  sums.add(x.second, x.second_elems, weights);
  Vec totals[1][kVecs];
  sums.total(totals);
  activator.apply(totals, first);
  MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) { vst1q_f32(y + first + v * kLanes, totals[0][v]); }
}

[[maybe_unused]] inline void matvec(const TwoParts& x, const std::uint16_t* weights,
                                    const std::uint16_t* bias, const ActivationSpec& activation,
                                    std::int32_t outputs, float* y) {
  const Activator activator(activation, outputs);
  const std::ptrdiff_t reduction = std::ptrdiff_t{x.first_elems} + x.second_elems;
  const std::int32_t padded = blocks_of(outputs) * kBlock;
  std::int32_t first = 0;
  for (; first + kPanel <= padded; first += kPanel, weights += reduction * kPanel) {
    matvec_panel<kPanel / kLanes>(x, weights, bias, activator, first, y);
  }
  if (first < padded) {
    matvec_panel<kBlock / kLanes>(x, weights, bias, activator, first, y);
  }
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
