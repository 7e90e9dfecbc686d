// Matrix-vector product on packed panels, for fully connected, causal convolution and LSTM layers.
#pragma once

#include "kernels/common/avx2.h"

namespace mien::kernels::avx2 {
namespace {

// Four independent sums hide the latency of fused multiply-adds.
template <int kVecs>
struct PanelSums {
  Vec sum[4][kVecs];

  void clear() {
    for (auto& lane : sum) {
      for (Vec& one : lane) {
        one = _mm256_setzero_ps();
      }
    }
  }
  // n must be a multiple of 4. Returns the address of the next weights.
  const std::uint16_t* add(const float* x, std::int32_t n, const std::uint16_t* w) {
    for (std::int32_t k = 0; k < n; k += 4) {
      for (int u = 0; u < 4; ++u, w += kVecs * kLanes) {
        const Vec value = _mm256_broadcast_ss(x + k + u);
        for (int v = 0; v < kVecs; ++v) {
          sum[u][v] = _mm256_fmadd_ps(value, load_half(w + v * kLanes), sum[u][v]);
        }
      }
    }
    return w;
  }
  [[nodiscard]] Vec total(int v) const {
    return _mm256_add_ps(_mm256_add_ps(sum[0][v], sum[1][v]), _mm256_add_ps(sum[2][v], sum[3][v]));
  }
};

struct TwoParts {
  const float* first;
  std::int32_t first_elems;
  const float* second;
  std::int32_t second_elems;
};

template <int kVecs>
inline void matvec_panel(const TwoParts& x, const std::uint16_t* weights, const std::uint16_t* bias,
                         const ActivationSpec& activation, std::int32_t block, std::int32_t outputs,
                         float* y) {
  PanelSums<kVecs> sums;
  sums.clear();
  weights = sums.add(x.first, x.first_elems, weights);
  sums.add(x.second, x.second_elems, weights);
  for (int v = 0; v < kVecs; ++v) {
    const Vec value = _mm256_add_ps(sums.total(v), load_half(bias + (block + v) * kLanes));
    _mm256_storeu_ps(y + (block + v) * kLanes, activated(value, activation, block + v, outputs));
  }
}

[[maybe_unused]] inline void matvec(const TwoParts& x, const std::uint16_t* weights,
                                    const std::uint16_t* bias, const ActivationSpec& activation,
                                    std::int32_t outputs, float* y) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{x.first_elems} + x.second_elems;
  const std::int32_t blocks = blocks_of(outputs);
  std::int32_t block = 0;
  for (; block + 2 <= blocks; block += 2, weights += reduction * kPanel) {
    matvec_panel<2>(x, weights, bias, activation, block, outputs, y);
  }
  if (block < blocks) {
    matvec_panel<1>(x, weights, bias, activation, block, outputs, y);
  }
}

}  // namespace
}  // namespace mien::kernels::avx2
