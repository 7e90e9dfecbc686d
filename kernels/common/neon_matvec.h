// Matrix-vector product on packed panels, for fully connected, causal convolution and LSTM layers.
#pragma once

#include "kernels/common/neon_activation.h"
#ifdef MIEN_HALF_TIER
#include "kernels/common/neon_half_sums.h"
#else
#include "kernels/common/neon_sums.h"
#endif

namespace mien::kernels::MIEN_TIER {
namespace {

struct TwoParts {
  const float* first;
  std::int32_t first_elems;
  const float* second;
  std::int32_t second_elems;
};

// Computes kVecs vectors of outputs.
template <int kVecs>
[[gnu::noinline]] void matvec_panel(const TwoParts& x, const std::uint16_t* weights,
                                    const std::uint16_t* bias, const Activator& activator,
                                    std::int32_t first, float* y) {
  PanelSums<kVecs> sums(bias + first);
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
