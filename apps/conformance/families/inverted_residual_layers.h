// The three layers of inverted_residual computed one after the other in double precision.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "apps/conformance/families/quantized_weights.h"

namespace mien::conformance::inverted_residual {

using kernels::Activation;

// The division of the work, which must not affect the result.
struct Tiling {
  int band_rows, strip_channels, strip_rows, strip_w;
};

struct Shape {
  Window window;
  int in_c, hidden_c, out_c;  // in_c 0: no expand layer
  Tiling tiling;
};

// The engine does not quantize longer sums.
inline bool has_quantized_weights(const Shape& s) {
  return std::max(s.in_c, s.hidden_c) <= kernels::kQuantizedWeightsMaxInputs;
}

// Whether no sum of the block is too long for fp16.
inline bool has_short_sums(const Shape& of, bool expands_in_int8) {
  return kernels::has_short_half_sums(expands_in_int8 ? 0 : of.in_c, of.window.kernel_h,
                                      of.window.kernel_w);
}

// Arithmetic of the block's inner sums: fp16 tiers use fp32 for blocks with long sums.
inline Arithmetic block_arithmetic(const Arithmetic& tier, bool short_sums) {
  const bool is_fp16 = tier.unit > kUnit;
  return is_fp16 && !short_sums ? kSingleArithmetic : tier;
}

struct Activations {
  RandomActivation expand, depthwise, project;
};

// The kernel's fp32 scales differ slightly from those used here.
inline constexpr double kHalfScale = 0.5 * (1.0 + 0x1p-12);

// A sum of products of inexact factors.
class InexactSum {
 public:
  explicit InexactSum(const Arithmetic& by) : sum_(by) {}
  void add(const Approx& x, double w = 1.0, double w_error = 0.0) {
    sum_.add(x.value, w);
    error_ += x.error * (std::abs(w) + w_error) + std::abs(x.value) * w_error;
  }
  [[nodiscard]] Approx total() const {
    const Approx total = sum_.total();
    return {total.value, total.error + error_ * (1.0 + kUnit)};
  }

 private:
  Sum sum_;
  double error_ = 0.0;
};

// The three layers in sequence; blocked maps [channel block][pixel][8].
struct Layers {
  Shape shape;
  Arithmetic sums, inner_sums;  // inner_sums: expand and depthwise
  std::vector<float> x;
  std::vector<std::uint16_t> w1, b1, w2, b2, w3, b3;
  QuantizedWeights quantized1, quantized3;  // w1 and w3
  int int8_panel;                           // outputs of a panel of the following
  Int8Weights int8_1, int8_3;
  bool is_quantized = false;           // expand and project are quantized
  float bound1 = 0.0f, bound3 = 0.0f;  // of inputs of expand and project with 8 bits, else 0

  Layers(RandomValues& random, const Shape& of)
      : shape(of),
        sums(block_arithmetic(random.arithmetic(), has_short_sums(of, false))),
        inner_sums(in_one_chunk(sums)),
        x(random.map(of.window.in_pixels(), of.in_c == 0 ? of.hidden_c : of.in_c)),
        w2(random.halves(padded(of.hidden_c) * of.window.kernel_h * of.window.kernel_w)),
        b2(random.bias(of.hidden_c)),
        w3(random.panels(of.out_c, padded(of.hidden_c))),
        b3(random.bias(of.out_c)),
        int8_panel(random.arithmetic().int8_panel) {
    if (of.in_c > 0) {
      w1 = random.panels(of.hidden_c, padded(of.in_c));
      b1 = random.bias(of.hidden_c);
    }
    if (random.is_half()) {
      scale_input(0x1p-8f);
    } else if (random.pattern() == Pattern::kHuge) {
      scale_input(1e-12f);
    }
    quantize_weights(of);
  }

  void quantize_weights(const Shape& of) {
    if (!has_quantized_weights(of)) {
      return;
    }
    quantized3 = QuantizedWeights(w3, of.out_c, of.hidden_c, kernels::kQuantizedBandMax, false);
    int8_3 = Int8Weights(w3, of.out_c, of.hidden_c, int8_panel);
    if (of.in_c > 0) {
      quantized1 = QuantizedWeights(w1, of.hidden_c, of.in_c, kernels::kQuantizedMapMax, true);
      int8_1 = Int8Weights(w1, of.hidden_c, of.in_c, int8_panel);
    }
  }

  // Gives expand, project or both 8 bits, with bounds that some inputs exceed or none reaches.
  void choose_int8(RandomValues& random, const RandomActivation& depthwise) {
    const float factor = 0.5f * static_cast<float>(random.between(1, 3));
    if (shape.in_c > 0 && random.coin()) {
      bound1 = std::clamp(factor * largest_input(), 0x1p-64f, 0x1p64f);
    }
    if (random.coin()) {
      bound3 = factor * static_cast<float>(band_max(depthwise));
    }
    if (random.is_half()) {
      const bool short_sums = has_short_sums(shape, bound1 > 0.0f);
      if (!short_sums) {  // in fp32, not in 8 bits
        bound1 = bound3 = 0.0f;
      }
      sums = block_arithmetic(random.arithmetic(), short_sums);
      inner_sums = in_one_chunk(sums);
    }
  }

  [[nodiscard]] float largest_input() const {
    float largest = 0x1p-64f;
    for (const float one : x) {
      largest = std::max(largest, std::abs(one));
    }
    return largest;
  }
  static double band_max(const RandomActivation& activation) {
    return activation.kind == Activation::kClamp01 ? 1.0 : 6.0;
  }

  // How an input of expand or project is rounded: half a scale, and the bound beyond which it
  // saturates.
  struct Rounding {
    double half_scale = 0.0, bound = 0x1p127;
    [[nodiscard]] Approx operator()(const Approx& input) const {
      return {std::clamp(input.value, -bound, bound), input.error + half_scale};
    }
  };
  static Rounding int8_rounding(float bound, int max) {
    return {static_cast<double>(bound) / max * kHalfScale, static_cast<double>(bound)};
  }
  [[nodiscard]] Rounding x_rounding() const {
    if (bound1 > 0.0f) {
      return int8_rounding(bound1, kernels::kInt8MapMax);
    }
    const double scale = static_cast<double>(largest_input()) / kernels::kQuantizedMapMax;
    return is_quantized ? Rounding{scale * kHalfScale} : Rounding{};
  }
  [[nodiscard]] Rounding depthwise_rounding(const RandomActivation& activation) const {
    if (bound3 > 0.0f) {
      const float reached = std::min(bound3, static_cast<float>(band_max(activation)));
      return int8_rounding(reached, kernels::kInt8BandMax);
    }
    const double scale = band_max(activation) / kernels::kQuantizedBandMax;
    return is_quantized ? Rounding{scale * kHalfScale} : Rounding{};
  }
  // Half a scale of the weights of output o.
  [[nodiscard]] double weight_error(const QuantizedWeights& int16, const Int8Weights& int8,
                                    bool is_int8, int o) const {
    const std::vector<float>& scales = is_int8 ? int8.scales : int16.scales;
    return is_int8 || is_quantized ? static_cast<double>(scales[as_size(o)]) * kHalfScale : 0.0;
  }

  void make_positive() {
    for (float& one : x) {
      one = std::abs(one);
    }
    for (std::vector<std::uint16_t>* weights : {&w1, &w2, &w3}) {
      for (std::uint16_t& one : *weights) {
        one &= 0x7fff;
      }
    }
    quantize_weights(shape);
  }

  // Scales x so that the largest sum of products of the expansion is `largest`. A bias that is much
  // larger than the products would absorb each of them, an error that grows with their number.
  void scale_products(double largest) {
    const std::vector<Approx> expansion = expanded({});
    const int pixels = shape.window.in_pixels();
    double now = 0x1p-126;
    for (int c = 0; c < shape.hidden_c; ++c) {
      for (int p = 0; p < pixels; ++p) {
        now = std::max(now,
                       std::abs(expansion[blocked(c, p, pixels)].value - widened(b1[as_size(c)])));
      }
    }
    scale_input(static_cast<float>(largest / now));
  }

  // Used to keep huge values within range: three layers would overflow any type.
  void scale_input(float factor) {
    for (float& one : x) {
      one *= factor;
    }
  }

  [[nodiscard]] std::vector<Approx> expanded(const RandomActivation& activation) const {
    const int pixels = shape.window.in_pixels();
    const Rounding rounding = x_rounding();
    return expected_map(shape.hidden_c, pixels, [&](int c, int p) {
      if (shape.in_c == 0) {
        return exact(static_cast<double>(x[blocked(c, p, pixels)]));
      }
      InexactSum sum(inner_sums);
      sum.add(exact(widened(b1[as_size(c)])));
      for (int i = 0; i < shape.in_c; ++i) {
        const auto value = static_cast<double>(x[blocked(i, p, pixels)]);
        sum.add(rounding(exact(value)), panel_weight(w1, shape.hidden_c, padded(shape.in_c), c, i),
                weight_error(quantized1, int8_1, bound1 > 0.0f, c));
      }
      return activation(sum.total(), c);
    });
  }

  [[nodiscard]] std::vector<Approx> depthwise_output(const std::vector<Approx>& fp32_weights,
                                                     const RandomActivation& activation) const {
    const Window& window = shape.window;
    const int taps = window.kernel_h * window.kernel_w;
    return expected_map(shape.hidden_c, window.out_pixels(), [&](int c, int p) {
      InexactSum sum(inner_sums);
      sum.add(exact(widened(b2[as_size(c)])));
      window.for_each(p, [&](int tap, int pixel) {
        sum.add(fp32_weights[blocked(c, pixel, window.in_pixels())],
                widened(w2[blocked(c, tap, taps)]));
      });
      return activation(sum.total(), c);
    });
  }

  // `rounding`: of the depthwise output.
  [[nodiscard]] Approx projected(const std::vector<Approx>& half_input, const Rounding& rounding,
                                 int o, int p) const {
    InexactSum sum(sums);
    sum.add(exact(widened(b3[as_size(o)])));
    for (int c = 0; c < shape.hidden_c; ++c) {
      sum.add(rounding(half_input[blocked(c, p, shape.window.out_pixels())]),
              panel_weight(w3, shape.out_c, padded(shape.hidden_c), o, c),
              weight_error(quantized3, int8_3, bound3 > 0.0f, o));
    }
    return sum.total();
  }
};

inline std::vector<Approx> expected(const Layers& layers, const Activations& activations,
                                    const ResidualSlice* slice,
                                    const std::vector<float>& residual) {
  const std::vector<Approx> depthwise_output =
      layers.depthwise_output(layers.expanded(activations.expand), activations.depthwise);
  const Window& window = layers.shape.window;
  const Layers::Rounding rounding = layers.depthwise_rounding(activations.depthwise);
  return expected_map(layers.shape.out_c, window.out_pixels(), [&](int o, int p) {
    const Approx y = activations.project(layers.projected(depthwise_output, rounding, o, p), o);
    return slice == nullptr
               ? y
               : y + exact(static_cast<double>(
                         residual[blocked(o, slice->pixel(p, window.out_w), slice->pixels())]));
  });
}

}  // namespace mien::conformance::inverted_residual
