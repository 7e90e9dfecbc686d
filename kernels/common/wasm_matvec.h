// Matrix-vector product on packed panels, for fully connected, causal convolution and LSTM layers.
#pragma once

#include "kernels/common/wasm_activation.h"
#include "kernels/common/wasm_weights.h"

namespace mien::kernels::wasm {
namespace {

struct TwoParts {
  const float* first;
  std::int32_t first_elems;
  const float* second;
  std::int32_t second_elems;
};

// n must be a multiple of 8. Returns the address of the next weights. One sum per vector is enough,
// because converting weights takes longer than the latency of an addition.
template <int kVecs>
inline const std::uint16_t* add_inputs(const float* x, std::int32_t n, const std::uint16_t* w,
                                       Vec (&sums)[1][kVecs]) {
  for (std::int32_t k = 0; k < n; k += kBlock, x += kBlock) {
    for (int i = 0; i < kBlock; ++i, w += kVecs * kLanes) {
      add_input(x + i, 0, w, sums);
    }
  }
  return w;
}

// Computes kVecs vectors of outputs, one panel.
template <int kVecs>
inline void matvec_panel(const TwoParts& x, const std::uint16_t* weights, const std::uint16_t* bias,
                         const Activator& activator, std::int32_t first, float* y) {
  Vec sums[1][kVecs];
  start_sums(bias + first, sums);
  weights = add_inputs(x.first, x.first_elems, weights, sums);
  add_inputs(x.second, x.second_elems, weights, sums);
  for (int v = 0; v < kVecs; ++v) {
    const std::int32_t channel = first + v * kLanes;
    store(y + channel, activator.clamped(sums[0][v]));
    activator.curve_channels(y + channel, 1, channel);
  }
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
}  // namespace mien::kernels::wasm
