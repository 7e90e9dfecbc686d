// Matrix-vector product on packed panels, for fully connected, causal convolution and LSTM layers.
#pragma once

#include "kernels/common/avx512.h"

namespace mien::kernels::avx512 {
namespace {

struct TwoParts {
  const float* first;
  std::int32_t first_elems;
  const float* second;
  std::int32_t second_elems;
};

// Sums of kPanels panels at once, each split in two to hide the latency of multiply-adds.
template <int kPanels>
struct PanelSums {
  Vec sum[2][kPanels];

  // n must be a multiple of 8; `panel_elems` is the distance between panels of weights.
  void add(const float* x, std::int32_t n, const std::uint16_t* w, std::ptrdiff_t panel_elems) {
    for (std::int32_t k = 0; k < n; k += 4, w += 4 * kPanel) {
#pragma GCC unroll 4
      for (int u = 0; u < 4; ++u) {
        const Vec value = _mm512_set1_ps(x[k + u]);
#pragma GCC unroll 4
        for (int p = 0; p < kPanels; ++p) {
          sum[u % 2][p] =
              _mm512_fmadd_ps(value, load_half(w + p * panel_elems + u * kPanel), sum[u % 2][p]);
        }
      }
    }
  }
};

// A last panel of 8 outputs: adds two elements at once.
inline Vec half_panel_sum(const float* x, std::int32_t n, const std::uint16_t* w, Vec sum) {
  Vec other = _mm512_setzero_ps();
  const auto two = [x](std::int32_t k) {
    return _mm512_insertf32x8(_mm512_set1_ps(x[k]), _mm256_set1_ps(x[k + 1]), 1);
  };
  for (std::int32_t k = 0; k < n; k += 4, w += 2 * kPanel) {
    sum = _mm512_fmadd_ps(two(k), load_half(w), sum);
    other = _mm512_fmadd_ps(two(k + 2), load_half(w + kPanel), other);
  }
  return _mm512_add_ps(sum, other);
}

struct MatvecArgs {
  TwoParts x;
  const std::uint16_t* weights;
  const std::uint16_t* bias;
  const ActivationSpec& activation;
  std::int32_t outputs;
  float* y;

  [[nodiscard]] std::ptrdiff_t reduction() const {
    return std::ptrdiff_t{x.first_elems} + x.second_elems;
  }
};

template <int kPanels>
inline void matvec_panels(const MatvecArgs& a, std::int32_t panel) {
  const std::ptrdiff_t panel_elems = a.reduction() * kPanel;
  const std::uint16_t* w = a.weights + panel * panel_elems;
  PanelSums<kPanels> sums;
  for (int p = 0; p < kPanels; ++p) {
    sums.sum[0][p] = load_half(a.bias + (panel + p) * kPanel);
    sums.sum[1][p] = _mm512_setzero_ps();
  }
  sums.add(a.x.first, a.x.first_elems, w, panel_elems);
  sums.add(a.x.second, a.x.second_elems, w + std::ptrdiff_t{a.x.first_elems} * kPanel, panel_elems);
  for (int p = 0; p < kPanels; ++p) {
    const std::int32_t channel = (panel + p) * kPanel;
    const Vec total = _mm512_add_ps(sums.sum[0][p], sums.sum[1][p]);
    _mm512_storeu_ps(a.y + channel,
                     activated(total, a.activation, channel, first_lanes(a.outputs - channel)));
  }
}

inline void matvec_half_panel(const MatvecArgs& a, std::int32_t channel) {
  const std::uint16_t* w = a.weights + channel * a.reduction();
  Vec sum = load_half(a.bias + channel, 0xFF);
  sum = half_panel_sum(a.x.first, a.x.first_elems, w, sum);
  w += std::ptrdiff_t{a.x.first_elems} * kBlock;
  sum = half_panel_sum(a.x.second, a.x.second_elems, w, sum);
  const __m256 total = _mm256_add_ps(_mm512_castps512_ps256(sum), _mm512_extractf32x8_ps(sum, 1));
  const Vec value = activated(_mm512_zextps256_ps512(total), a.activation, channel,
                              first_lanes(a.outputs - channel));
  _mm256_storeu_ps(a.y + channel, _mm512_castps512_ps256(value));
}

[[maybe_unused]] inline void matvec(const MatvecArgs& a) {
  const std::int32_t blocks = blocks_of(a.outputs);
  std::int32_t panel = 0;
  for (; panel + 4 <= blocks / 2; panel += 4) {
    matvec_panels<4>(a, panel);
  }
  for (; panel < blocks / 2; ++panel) {
    matvec_panels<1>(a, panel);
  }
  if (blocks % 2 != 0) {
    matvec_half_panel(a, panel * kPanel);
  }
}

}  // namespace
}  // namespace mien::kernels::avx512
