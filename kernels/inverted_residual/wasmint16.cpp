// The wasmint16 tier of inverted_residual. Its depthwise part computes 4 channels at once: a
// quarter of a panel.
#include "kernels/common/wasm_fixed.h"
#include "kernels/depthwise/wasm_window.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/quantized_strips.h"

namespace mien::kernels::wasmint16 {
namespace {

using wasm::fixed;
using wasm::kLanes;
using wasm::load_half;
using wasm::max;
using wasm::min;
using wasm::splat;
using wasm::Vec;

// Computes the band of 4 channels: quantized values, or floats.
template <bool kQuantized>
struct Window {
  static constexpr std::ptrdiff_t kBand = kQuantized ? kQuantizedBand : kStripBlock;

  const InvertedResidualArgs& a;
  std::ptrdiff_t x_row_elems;
  const std::uint16_t* weights;  // [kernel_h][kernel_w][8], from the first of the channels on
  Vec factor, bias, low, high;

  [[nodiscard]] Vec weight(int tap) const {
    return wasm_f32x4_mul(load_half(weights + tap * kStripBlock), factor);
  }

  void store(Vec sum, float* y) const {
    const Vec value = min(max(sum, low), high);
    if constexpr (kQuantized) {
      wasm_v128_store64_lane(y, fixed(value, value), 0);
    } else {
      wasm::store(y, value);
    }
  }
};

// kColumns outputs of a 3x3 kernel, whose windows begin at x.
template <int kColumns, int kStride>
void columns_3x3(const Window<true>& m, const Vec (&weights)[9], const float* x, float* y) {
  Vec sums[kColumns];
  for (Vec& one : sums) {
    one = m.bias;
  }
  wasm::add_windows_3x3<kStride, kFloatPanel>(x, m.x_row_elems, weights, sums);
  for (int column = 0; column < kColumns; ++column) {
    m.store(sums[column], y + column * kQuantizedBand);
  }
}

template <int kStride>
void rows_3x3(const Window<true>& m, std::int32_t rows, const float* x, float* y) {
  constexpr int kColumns = 4;
  Vec weights[9];
  for (int tap = 0; tap < 9; ++tap) {
    weights[tap] = m.weight(tap);
  }
  for (; rows > 0; --rows, x += kStride * m.x_row_elems) {
    const float* from = x;
    std::int32_t left = m.a.out_w;
    for (; left >= kColumns; left -= kColumns) {
      columns_3x3<kColumns, kStride>(m, weights, from, y);
      from += kColumns * kStride * kFloatPanel;
      y += kColumns * kQuantizedBand;
    }
    for (; left > 0; --left, from += kStride * kFloatPanel, y += kQuantizedBand) {
      columns_3x3<1, kStride>(m, weights, from, y);
    }
  }
}

// Any kernel size and stride, one pixel at a time.
template <bool kQuantized>
void any_rows(const Window<kQuantized>& m, std::int32_t rows, const float* x, float* y) {
  for (; rows > 0; --rows, x += m.a.stride_h * m.x_row_elems) {
    for (std::int32_t ox = 0; ox < m.a.out_w; ++ox, y += Window<kQuantized>::kBand) {
      const float* row = x + std::ptrdiff_t{ox} * m.a.stride_w * kFloatPanel;
      Vec sum = m.bias;
      std::int32_t tap = 0;
      for (std::int32_t ky = 0; ky < m.a.kernel_h; ++ky, row += m.x_row_elems) {
        for (std::int32_t kx = 0; kx < m.a.kernel_w; ++kx, ++tap) {
          const Vec input = wasm::load(row + std::ptrdiff_t{kx} * kFloatPanel);
          sum = wasm::add_product(sum, input, m.weight(tap));
        }
      }
      m.store(sum, y);
    }
  }
}

// Blocks in fp32 are rare, so they have no code of their own for 3x3 kernels.
template <bool kQuantized>
void rows_of(const Window<kQuantized>& m, std::int32_t rows, const float* x, float* y) {
  if constexpr (kQuantized) {
    if (m.a.kernel_h == 3 && m.a.kernel_w == 3 && m.a.stride_h == m.a.stride_w) {
      if (m.a.stride_w == 1) {
        return rows_3x3<1>(m, rows, x, y);
      }
      if (m.a.stride_w == 2) {
        return rows_3x3<2>(m, rows, x, y);
      }
    }
  }
  any_rows(m, rows, x, y);
}

// Runs the quarters of the part. `plane` is the distance between blocks of the band.
template <bool kQuantized>
void depthwise_quarters(const InvertedResidualArgs& a, const DepthwisePart<float>& s, float factor,
                        float high, float* y, std::ptrdiff_t plane) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  for (std::int32_t channel = 0; channel < s.blocks * kStripBlock; channel += kLanes) {
    const std::int32_t half = channel / kStripBlock, lane = channel % kStripBlock;
    const std::ptrdiff_t block = s.block + half;
    const std::uint16_t* bias = a.depthwise.bias + block * kStripBlock + lane;
    const Window<kQuantized> window{a,
                                    s.x_row_elems,
                                    a.depthwise.weights + block * taps * kStripBlock + lane,
                                    splat(factor),
                                    wasm_f32x4_mul(load_half(bias), splat(factor)),
                                    splat(s.clamp.low),
                                    splat(high)};
    const std::ptrdiff_t lanes_before = lane * Window<kQuantized>::kBand / kStripBlock;
    rows_of(window, s.rows, s.x + channel, y + half * plane + lanes_before);
  }
}

struct Tier16 {
  static void load(const float* x, float* y) {
    wasm::store(y, wasm::load(x));
    wasm::store(y + kLanes, wasm::load(x + kLanes));
  }

  static float largest_of(const float* x, std::ptrdiff_t elems) {
    Vec largest[2] = {splat(kMinMagnitude), splat(kMinMagnitude)};
    for (; elems > 0; elems -= kStripBlock, x += kStripBlock) {
      for (int k = 0; k < 2; ++k) {
        largest[k] = max(largest[k], wasm_f32x4_abs(wasm::load(x + k * kLanes)));
      }
    }
    const Vec all = wasm::across(max(largest[0], largest[1]), &max);
    return wasm_f32x4_extract_lane(all, 0);
  }

  static void quantize(const float* x, std::ptrdiff_t elems, float inverse_scale, std::int16_t* y) {
    const Vec factor = splat(inverse_scale);
    for (; elems > 0; elems -= kStripBlock, x += kStripBlock, y += kStripBlock) {
      const Vec low = wasm_f32x4_mul(wasm::load(x), factor);
      const Vec high = wasm_f32x4_mul(wasm::load(x + kLanes), factor);
      wasm_v128_store(y, fixed(low, high));
    }
  }

  static void quantize_to_int8(const float*, std::int32_t, float, std::int16_t*) {}

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s,
                        const BandQuantization& quantization, float* y) {
    depthwise_quarters<true>(a, s, quantization.factor(), quantization.max, y,
                             quantized_band_plane(a, s));
  }

  static void multiply(const QuantizedProduct& product) { multiply_quantized(product); }
};

// For blocks that cannot be quantized.
struct Tier32 {
  static void load(const float* x, float* y) { Tier16::load(x, y); }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s) {
    depthwise_quarters<false>(a, s, 1.0f, s.clamp.high, band_at(a, s), band_plane(a, s));
  }

  static void multiply(const ProductArgs& product) { multiply_floats(product); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  using Strips = QuantizedStrips<Tier16>;
  if (Strips::can_run(a)) {
    InvertedResidual<Strips>(a).run();
  } else {
    InvertedResidual<FloatStrips<Tier32>>(a).run();
  }
}

}  // namespace mien::kernels::wasmint16
