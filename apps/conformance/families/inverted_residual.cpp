// Cases of inverted_residual, with the expected results.
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "apps/conformance/families/inverted_residual_layers.h"

namespace mien::conformance {
namespace {

using inverted_residual::Activations;
using inverted_residual::has_quantized_weights;
using inverted_residual::Layers;
using inverted_residual::Shape;
using inverted_residual::Tiling;
using kernels::Activation;
using kernels::InvertedResidualArgs;

constexpr int kLongCases = 8;  // every eighth case has long sums

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

void set_int8(float bound, const std::int8_t* quads, const float* sums,
              InvertedResidualArgs::Weights& weights) {
  if (bound > 0.0f) {
    weights.pairs = nullptr;
    weights.quads = quads;
    weights.sums = sums;
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
  const bool may_quantize = has_quantized_weights(shape) && is_bounded(activations.depthwise);
  layers.is_quantized = random.arithmetic().is_quantized && may_quantize;
  if (may_quantize && random.arithmetic().has_int8) {
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
      reads(layers.int8_1.sums),
      reads(layers.int8_3.quads),
      reads(layers.int8_3.sums)};
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
  layers.scale_products(3.0);
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
