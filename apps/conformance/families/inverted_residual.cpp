// Cases of inverted_residual, with the expected results.
#include <algorithm>
#include <array>
#include <iterator>

#include "apps/conformance/families/quantized_weights.h"

namespace mien::conformance {
namespace {

using kernels::Activation;
using kernels::InvertedResidualArgs;

// The division of the work, which must not affect the result.
struct Tiling {
  int band_rows, strip_channels, strip_rows, strip_w;
};

struct Shape {
  Window window;
  int in_c, hidden_c, out_c;  // in_c 0: no expand layer
  Tiling tiling;
};

constexpr int kLongCases = 8;  // every eighth case has long sums

// The engine does not quantize longer sums.
bool has_quantized_weights(const Shape& s) {
  return std::max(s.in_c, s.hidden_c) <= kernels::kQuantizedWeightsMaxInputs;
}

// Arithmetic of the block's inner sums: fp16 tiers use fp32 for blocks with long sums.
Arithmetic block_arithmetic(const Arithmetic& tier, const Shape& of) {
  const bool short_sums =
      kernels::has_short_half_sums(of.in_c, of.window.kernel_h, of.window.kernel_w);
  const bool is_fp16 = tier.unit > kUnit;
  return is_fp16 && !short_sums ? kSingleArithmetic : tier;
}

struct Activations {
  RandomActivation expand, depthwise, project;
};

// The kernel's fp32 scales differ slightly from those used here.
constexpr double kHalfScale = 0.5 * (1.0 + 0x1p-12);

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
  Int8Weights int8_1, int8_3;
  bool is_quantized = false;           // expand and project are quantized
  float bound1 = 0.0f, bound3 = 0.0f;  // of inputs of expand and project with 8 bits, else 0

  Layers(RandomValues& random, const Shape& of)
      : shape(of),
        sums(block_arithmetic(random.arithmetic(), of)),
        inner_sums(in_one_chunk(sums)),
        x(random.map(of.window.in_pixels(), of.in_c == 0 ? of.hidden_c : of.in_c)),
        w2(random.halves(padded(of.hidden_c) * of.window.kernel_h * of.window.kernel_w)),
        b2(random.bias(of.hidden_c)),
        w3(random.panels(of.out_c, padded(of.hidden_c))),
        b3(random.bias(of.out_c)) {
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
    int8_3 = Int8Weights(w3, of.out_c, of.hidden_c, 0);
    if (of.in_c > 0) {
      quantized1 = QuantizedWeights(w1, of.hidden_c, of.in_c, kernels::kQuantizedMapMax, true);
      int8_1 = Int8Weights(w1, of.hidden_c, of.in_c, kernels::kInt8Shift);
    }
  }

  // Gives expand, project or both 8 bits, with bounds that some inputs exceed or none reaches.
  void choose_int8(RandomValues& random, const RandomActivation& depthwise) {
    const float share = 0.5f * static_cast<float>(random.between(1, 3));
    if (shape.in_c > 0 && random.coin()) {
      bound1 = std::clamp(share * largest_input(), 0x1p-64f, 0x1p64f);
    }
    if (random.coin()) {
      bound3 = share * static_cast<float>(band_max(depthwise));
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
    return is_quantized ? static_cast<double>(scales[as_size(o)]) * kHalfScale : 0.0;
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

  // Scales x so that the largest value of the expansion is `largest`.
  void scale_expansion(double largest) {
    double now = 0x1p-126;
    for (const Approx& one : expanded({})) {
      now = std::max(now, std::abs(one.value));
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

std::vector<Approx> expected(const Layers& layers, const Activations& activations,
                             const ResidualSlice* slice, const std::vector<float>& residual) {
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

std::uint64_t mac_count(const Shape& s) {
  const int taps = s.window.kernel_h * s.window.kernel_w;
  return static_cast<std::uint64_t>(s.window.in_pixels()) * as_size(s.in_c * s.hidden_c) +
         static_cast<std::uint64_t>(s.window.out_pixels()) * as_size(s.hidden_c * (taps + s.out_c));
}

InvertedResidualArgs sizes(const Shape& s) {
  InvertedResidualArgs args{};
  set_window(s.window, args);
  args.in_c = s.in_c == 0 ? s.hidden_c : s.in_c;
  args.hidden_c = s.hidden_c;
  args.out_c = s.out_c;
  args.band_rows = s.tiling.band_rows;
  args.strip_channels = s.tiling.strip_channels;
  args.strip_rows = s.tiling.strip_rows;
  args.strip_w = s.tiling.strip_w;
  return args;
}

int half_input_rows(const Shape& s) {
  return std::min(s.window.in_h, (s.tiling.band_rows - 1) * s.window.stride_h + s.window.kernel_h);
}

// Quantization requires a bounded activation.
bool is_bounded(const RandomActivation& activation) {
  return activation.kind == Activation::kRelu6 || activation.kind == Activation::kClamp01;
}

void set_int8(float bound, const std::int8_t* quads, const float* offsets,
              InvertedResidualArgs::Weights& weights) {
  if (bound > 0.0f) {
    weights.pairs = nullptr;
    weights.quads = quads;
    weights.offsets = offsets;
    weights.input_bound = bound;
  }
}

std::string description(const Layers& layers, const ResidualSlice* slice) {
  const Shape& shape = layers.shape;
  return shape.window.text() + ", " + std::to_string(shape.in_c) + " to " +
         std::to_string(shape.hidden_c) + " to " + std::to_string(shape.out_c) +
         (slice != nullptr ? ", residual" : "") +
         (layers.bound1 > 0.0f ? ", 8 bits in expand" : "") +
         (layers.bound3 > 0.0f ? ", 8 bits in project" : "");
}

void set_weights(const Addresses& buffers, const Activations& activations, const Shape& shape,
                 InvertedResidualArgs& args) {
  args.expand.weights = shape.in_c == 0 ? nullptr : buffers.halves(1);
  args.expand.bias = buffers.halves(2);
  args.expand.activation = activations.expand.spec(nullptr);
  args.depthwise.weights = buffers.halves(3);
  args.depthwise.bias = buffers.halves(4);
  args.depthwise.activation = activations.depthwise.spec(nullptr);
  args.project.weights = buffers.halves(5);
  args.project.bias = buffers.halves(6);
  args.project.activation = activations.project.spec(nullptr);
  if (has_quantized_weights(shape)) {
    args.expand.pairs = buffers.int16s(13);
    args.project.pairs = buffers.int16s(14);
    args.expand.scales = buffers.floats(15);
    args.project.scales = buffers.floats(16);
  }
}

Case make(RandomValues& random, Layers layers, const Activations& activations,
          const ResidualSlice* slice) {
  const Shape shape = layers.shape;
  layers.is_quantized = random.arithmetic().is_quantized && has_quantized_weights(shape) &&
                        is_bounded(activations.depthwise);
  if (layers.is_quantized && random.arithmetic().has_int8) {
    layers.choose_int8(random, activations.depthwise);
  }
  const std::vector<float> residual =
      slice != nullptr ? random.map(slice->pixels(), shape.out_c) : std::vector<float>();
  const Tiling& t = shape.tiling;
  Case test;
  test.shape = description(layers, slice);
  test.buffers = {
      reads(layers.x),
      reads(layers.w1),
      reads(layers.b1),
      reads(layers.w2),
      reads(layers.b2),
      reads(layers.w3),
      reads(layers.b3),
      reads(residual),
      scratch(as_size((shape.hidden_c + 15) / 16 * 16 * t.band_rows * shape.window.out_w)),
      scratch(as_size(t.strip_channels * t.strip_rows * t.strip_w)),
      scratch(as_size(kernels::kInvertedResidualFp32WeightElems)),
      scratch(as_size((shape.in_c + 31) / 32 * 16 * half_input_rows(shape) * shape.window.in_w)),
      writes(Element::kFloat, expected(layers, activations, slice, residual)),
      reads(layers.quantized1.pairs),
      reads(layers.quantized3.pairs),
      reads(layers.bound1 > 0.0f ? layers.int8_1.scales : layers.quantized1.scales),
      reads(layers.bound3 > 0.0f ? layers.int8_3.scales : layers.quantized3.scales),
      reads(layers.int8_1.quads),
      reads(layers.int8_1.offsets),
      reads(layers.int8_3.quads),
      reads(layers.int8_3.offsets)};
  const ResidualSlice taken = slice != nullptr ? *slice : ResidualSlice();
  const std::array<float, 2> bounds = {layers.bound1, layers.bound3};
  test.bind = [=](const Addresses& buffers) {
    InvertedResidualArgs args = sizes(shape);
    args.x = buffers.floats(0);
    set_weights(buffers, activations, shape, args);
    set_int8(bounds[0], buffers.int8s(17), buffers.floats(18), args.expand);
    set_int8(bounds[1], buffers.int8s(19), buffers.floats(20), args.project);
    if (taken.h > 0) {
      set_residual(taken, buffers.floats(7), args);
    }
    args.band = buffers.floats(8);
    args.strip = buffers.floats(9);
    args.fp32_weights = buffers.floats(10);
    args.half_input = buffers.floats(11);
    args.y = buffers.floats(12);
    return arguments(args);
  };
  test.call = call<InvertedResidualArgs>;
  test.macs = mac_count(shape);
  return test;
}

RandomActivation random_clamp(RandomValues& random) {
  constexpr Activation kClamps[] = {Activation::kNone, Activation::kRelu, Activation::kRelu6,
                                    Activation::kClamp01};
  RandomActivation activation;
  activation.kind = kClamps[random.between(0, static_cast<int>(std::size(kClamps)) - 1)];
  return activation;
}

int min_strip_w(const Window& w) {
  return std::max(w.pad_left + w.in_w, (w.out_w - 1) * w.stride_w + w.kernel_w);
}

Tiling random_tiling(RandomValues& random, const Window& w) {
  return {random.between(1, w.out_h), 16 * random.between(1, 4),
          w.kernel_h + w.stride_h * random.between(0, 3), min_strip_w(w) + random.between(0, 1)};
}

// Sums at the maximum length for fp16, one longer, the maximum for quantization, and longer ones.
Shape long_shape(RandomValues& random) {
  const Window one_tap{2, 2, 2, 2, 1, 1, 1, 1, 0, 0}, many_taps{13, 5, 1, 1, 13, 5, 1, 1, 0, 0};
  struct Sums {
    Window window;
    int in_c, hidden_c;
  };
  const int few = random.size(24), longest_half = kernels::kHalfMaxExpandInputs;
  const Sums all[] = {{one_tap, 4096, few},
                      {one_tap, few, 4096},
                      {many_taps, few, few},
                      {one_tap, longest_half + random.between(0, 1), few},
                      {one_tap, kernels::kQuantizedWeightsMaxInputs, few}};
  const Sums& sums = all[random.case_number() / kLongCases % static_cast<int>(std::size(all))];
  return {sums.window, sums.in_c, sums.hidden_c, random.size(10),
          random_tiling(random, sums.window)};
}

// Terms of one sign lose most in a running sum of low precision. No clamp hides errors, except
// where quantized tiers require one.
Case long_case(RandomValues& random) {
  const Shape shape = long_shape(random);
  Layers layers(random, shape);
  layers.make_positive();
  layers.scale_expansion(3.0);
  RandomActivation relu, relu6;
  relu.kind = Activation::kRelu;
  relu6.kind = Activation::kRelu6;
  const bool may_clamp = shape.window.kernel_h == 1;
  return make(random, std::move(layers), {relu, may_clamp ? relu6 : relu, {}}, nullptr);
}

}  // namespace

template <>
Case random_case<InvertedResidualArgs>(RandomValues& random) {
  if (random.case_number() % kLongCases == kLongCases - 1) {
    return long_case(random);
  }
  Window window = Window::random(random, 5, 2);
  while (random.case_number() % 3 != 0 && (window.kernel_h != 3 || window.kernel_w != 3)) {
    window = Window::random(random, 3, 2);
  }
  const int in_c = random.between(0, 3) == 0 ? 0 : random.size(40);
  const Shape shape{window, in_c, random.size(80), random.size(50), random_tiling(random, window)};
  const Activations activations{in_c == 0 ? RandomActivation() : random_clamp(random),
                                random_clamp(random), random_clamp(random)};
  const ResidualSlice slice = ResidualSlice::random(random, window.out_h, window.out_w);
  return make(random, Layers(random, shape), activations, random.coin() ? &slice : nullptr);
}

template <>
Case typical_case<InvertedResidualArgs>(RandomValues& random) {
  RandomActivation relu6;
  relu6.kind = Activation::kRelu6;
  const Window window{13, 11, 11, 9, 3, 3, 1, 1, 0, 0};
  const Shape shape{window, 40, 160, 40, {11, 32, 13, 11}};
  return make(random, Layers(random, shape), {relu6, relu6, {}}, nullptr);
}

}  // namespace mien::conformance
