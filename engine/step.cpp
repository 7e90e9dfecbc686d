// Translates layers to kernels and their arguments.
#include "engine/step.h"

#include <cstring>
#include <type_traits>

#include "engine/fused_block.h"

namespace mien::engine {

using formats::kNoIndex;
using formats::LayerActivation;
using formats::LayerOp;
using formats::LayerRecord;
using kernels::Activation;
using kernels::Curve;

namespace {

Activation kind_of(LayerActivation activation) {
  switch (activation) {
    case LayerActivation::kNone:
      return Activation::kNone;
    case LayerActivation::kRelu:
      return Activation::kRelu;
    case LayerActivation::kRelu6:
      return Activation::kRelu6;
    case LayerActivation::kLeakyRelu:
      return Activation::kLeakyRelu;
    case LayerActivation::kPrelu:
      return Activation::kPrelu;
    case LayerActivation::kSigmoid:
      return Activation::kSigmoid;
    case LayerActivation::kTanh:
      return Activation::kTanh;
    case LayerActivation::kClamp01:
      return Activation::kClamp01;
    default:  // curves, which only activation layers have
      return Activation::kNone;
  }
}

// Sets `curve` and returns true if the activation is a curve.
bool is_curve(LayerActivation activation, Curve& curve) {
  switch (activation) {
    case LayerActivation::kHardSwish:
      curve = Curve::kHardSwish;
      return true;
    case LayerActivation::kSwish:
      curve = Curve::kSwish;
      return true;
    case LayerActivation::kGelu:
      curve = Curve::kGelu;
      return true;
    case LayerActivation::kGeluTanh:
      curve = Curve::kGeluTanh;
      return true;
    case LayerActivation::kErf:
      curve = Curve::kErf;
      return true;
    case LayerActivation::kExp:
      curve = Curve::kExp;
      return true;
    case LayerActivation::kSqrt:
      curve = Curve::kSqrt;
      return true;
    default:
      return false;
  }
}

kernels::ResizeArgs resize(const LayerRecord& l, const Shape& x, const Shape& y) {
  kernels::ResizeArgs args{};
  args.in_h = x.h;
  args.in_w = x.w;
  args.out_h = y.h;
  args.out_w = y.w;
  args.channels = y.c;
  args.grid = static_cast<kernels::Grid>(l.flags % formats::kResizeGrids);
  args.sampling = static_cast<kernels::Sampling>(l.flags / formats::kResizeGrids);
  return args;
}

kernels::RearrangeArgs rearrange(const LayerRecord& l, const Shape& x, const Shape& y) {
  constexpr std::uint8_t kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                          {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  kernels::RearrangeArgs args{};
  args.in_h = x.h;
  args.in_w = x.w;
  args.in_c = x.c;
  args.out_h = y.h;
  args.out_w = y.w;
  args.out_c = y.c;
  for (int i = 0; i < 3; ++i) {
    args.order[i] = static_cast<kernels::Axis>(kOrders[l.flags][i]);
  }
  return args;
}

std::int32_t vector_elems(const Shape& shape) {
  return static_cast<std::int32_t>(blocked_elems(shape));
}

std::int32_t pixels(const Shape& shape) { return static_cast<std::int32_t>(shape.pixels()); }

// Sets the window fields that conv2d, depthwise and max_pool share.
template <class Args>
void set_windows(const LayerRecord& l, const Shape& x, const Shape& y, Args& args) {
  args.in_h = x.h;
  args.in_w = x.w;
  args.out_h = y.h;
  args.out_w = y.w;
  args.kernel_h = l.kernel_height;
  args.kernel_w = l.kernel_width;
  args.stride_h = l.stride_height;
  args.stride_w = l.stride_width;
  args.pad_top = l.pad_top;
  args.pad_left = l.pad_left;
}

// Adds the centre slice of `residual` with the size of `y`.
template <class Args>
void set_residual(const Shape& residual, const Shape& y, const float* data, Args& args) {
  args.residual = data;
  args.residual_h = residual.h;
  args.residual_w = residual.w;
  args.residual_top = (residual.h - y.h) / 2;
  args.residual_left = (residual.w - y.w) / 2;
}

}  // namespace

const std::uint16_t* StepMaker::halves(std::uint32_t tensor) const {
  return tensor == kNoIndex
             ? nullptr
             : reinterpret_cast<const std::uint16_t*>(file_.data(file_.tensors()[tensor]).data());
}

kernels::ActivationSpec StepMaker::activation(const LayerRecord& l) const {
  return {kind_of(static_cast<LayerActivation>(l.activation)), l.alpha, halves(l.slopes)};
}

template <class Args>
Args StepMaker::weighted(const LayerRecord& l, Map x, Map y) const {
  Args args{};
  args.x = x.data;
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = y.data;
  args.activation = activation(l);
  return args;
}

template <class Args>
mien_status StepMaker::put(const Args& args, Step& step) const {
  static_assert(sizeof(Args) <= Step::kArgsBytes && std::is_trivially_copyable_v<Args>);
  step.kernel = kernels::find_any(Args::kFamily, cpu_mask_);
  step.call = [](const Step& self) {
    reinterpret_cast<kernels::Kernel<Args>>(self.kernel)(*reinterpret_cast<const Args*>(self.args));
  };
  std::memcpy(step.args, &args, sizeof args);
  return step.kernel == nullptr ? MIEN_ERROR_UNSUPPORTED_LAYER : MIEN_OK;
}

mien_status StepMaker::put_activation(const LayerRecord& l, Map x, Map y, Step& step) const {
  Curve curve{};
  if (is_curve(static_cast<LayerActivation>(l.activation), curve)) {
    return put(kernels::CurveArgs{x.data, y.data, curve, pixels(y.shape), y.shape.c}, step);
  }
  return put(kernels::ActivateArgs{x.data, y.data, activation(l), pixels(y.shape), y.shape.c},
             step);
}

mien_status StepMaker::put_block(std::uint32_t layer, std::uint32_t depthwise_layer,
                                 const Memory& own, Step& step) const {
  kernels::InvertedResidualArgs args = block(layer, depthwise_layer);
  const mien_status status =
      plan_.weights_bytes(layer) > 0 ? quantize_block(layer, own.weights, args) : MIEN_OK;
  return status == MIEN_OK ? put(args, step) : status;
}

mien_status StepMaker::make(std::uint32_t layer, const Memory& own, Step& step) const {
  const LayerRecord& l = plan_.layer(layer);
  const std::uint32_t depthwise_layer = plan_.fused_depthwise(layer);
  if (depthwise_layer != kNoIndex) {
    return put_block(layer, depthwise_layer, own, step);
  }
  const Map x = map(l.input), y = map(layer + 1);
  switch (static_cast<LayerOp>(l.op)) {
    case LayerOp::kConv2d:
      return put(conv2d(l, x, y), step);
    case LayerOp::kDepthwise:
      return put(depthwise(l, x, y), step);
    case LayerOp::kPointwise:
      return put(pointwise(layer, x, y), step);
    case LayerOp::kFullyConnected:
      return put(fully_connected(l, x, y), step);
    case LayerOp::kCausalConv:
      return put(causal_conv(l, x, y, own.state), step);
    case LayerOp::kLstm:
      return put(lstm(l, x, y, own.state), step);
    case LayerOp::kMaxPool:
      return put(max_pool(l, x, y), step);
    case LayerOp::kAdd:
      return put(add(l, x, y), step);
    case LayerOp::kActivation:
      return put_activation(l, x, y, step);
    case LayerOp::kSoftmax:
      return put(kernels::SoftmaxArgs{x.data, y.data, pixels(y.shape), y.shape.c}, step);
    case LayerOp::kGlobalAveragePool:
      return put(kernels::GlobalAveragePoolArgs{x.data, y.data, pixels(x.shape), x.shape.c}, step);
    case LayerOp::kConcat:
      return put(concat(l, x, y), step);
    case LayerOp::kSlice:
      return put(slice(l, x, y), step);
    case LayerOp::kMultiply:
      return put(combine(kernels::Combination::kProduct, l, x, y), step);
    case LayerOp::kDivide:
      return put(combine(kernels::Combination::kQuotient, l, x, y), step);
    case LayerOp::kBroadcastAdd:
      return put(combine(kernels::Combination::kSum, l, x, y), step);
    case LayerOp::kResize: {
      kernels::ResizeArgs args = resize(l, x.shape, y.shape);
      args.x = x.data;
      args.y = y.data;
      return put(args, step);
    }
    case LayerOp::kRearrange: {
      kernels::RearrangeArgs args = rearrange(l, x.shape, y.shape);
      args.x = x.data;
      args.y = y.data;
      return put(args, step);
    }
    case LayerOp::kNormalize:
      return put(kernels::NormalizeArgs{x.data, y.data, l.alpha, pixels(y.shape), y.shape.c}, step);
  }
  return MIEN_ERROR_UNSUPPORTED_LAYER;
}

kernels::Conv2dArgs StepMaker::conv2d(const LayerRecord& l, Map x, Map y) const {
  auto args = weighted<kernels::Conv2dArgs>(l, x, y);
  set_windows(l, x.shape, y.shape, args);
  args.in_c = x.shape.c;
  args.x_pixel_elems = l.input == 0 && x.shape.interleaved() ? x.shape.c : 8;
  args.out_c = y.shape.c;
  return args;
}

kernels::DepthwiseArgs StepMaker::depthwise(const LayerRecord& l, Map x, Map y) const {
  auto args = weighted<kernels::DepthwiseArgs>(l, x, y);
  args.channels = y.shape.c;
  set_windows(l, x.shape, y.shape, args);
  return args;
}

kernels::InvertedResidualArgs::Weights StepMaker::weights(std::uint32_t layer) const {
  const LayerRecord& l = plan_.layer(layer);
  kernels::InvertedResidualArgs::Weights weights{};
  weights.weights = halves(l.weights);
  weights.bias = halves(l.bias);
  weights.activation = activation(l);
  return weights;
}

// Arguments for layers `layer` .. depthwise_layer + 1, and for the next addition if it is fused.
kernels::InvertedResidualArgs StepMaker::block(std::uint32_t layer,
                                               std::uint32_t depthwise_layer) const {
  const LayerRecord& l = plan_.layer(depthwise_layer);
  const Map x = map(plan_.layer(layer).input), y = map(layer + plan_.step_layers(layer));
  const Shape hidden = plan_.value(l.input).shape,
              depthwise_output = plan_.value(depthwise_layer + 1).shape;
  kernels::InvertedResidualArgs args{};
  args.x = x.data;
  args.y = y.data;
  args.expand = layer < depthwise_layer ? weights(layer) : kernels::InvertedResidualArgs::Weights{};
  args.depthwise = weights(depthwise_layer);
  args.project = weights(depthwise_layer + 1);
  set_windows(l, hidden, depthwise_output, args);
  args.in_c = x.shape.c;
  args.hidden_c = hidden.c;
  args.out_c = y.shape.c;
  const std::uint32_t sum = plan_.fused_addition(depthwise_layer + 1);
  if (sum != kNoIndex) {
    const Map residual = map(plan_.layer(sum).second_input);
    set_residual(residual.shape, y.shape, residual.data, args);
  }
  const BlockTiling tiling = plan_.tiling(layer);
  args.band = scratch_;
  args.strip = args.band + tiling.band_elems;
  args.fp32_weights = args.strip + tiling.strip_elems;
  args.half_input = args.fp32_weights + kernels::kInvertedResidualFp32WeightElems;
  args.band_rows = tiling.band_rows;
  args.strip_channels = tiling.strip_channels;
  args.strip_rows = tiling.strip_rows;
  args.strip_w = tiling.strip_w;
  return args;
}

// Rounds the weights of the block that begins with `layer` once, at creation.
mien_status StepMaker::quantize_block(std::uint32_t layer, std::byte* to,
                                      kernels::InvertedResidualArgs& args) const {
  if (args.expand.weights != nullptr) {
    const QuantizedLayer expand = plan_.quantized_layer(layer);
    const mien_status status = quantize_weights(expand, cpu_mask_, to, args.expand);
    if (status != MIEN_OK) {
      return status;
    }
    to += quantized_weights_bytes(expand);
  }
  const QuantizedLayer project = plan_.quantized_layer(plan_.fused_depthwise(layer) + 1);
  return quantize_weights(project, cpu_mask_, to, args.project);
}

kernels::PointwiseArgs StepMaker::pointwise(std::uint32_t layer, Map x, Map y) const {
  const LayerRecord& l = plan_.layer(layer);
  auto args = weighted<kernels::PointwiseArgs>(l, x, y);
  args.h = y.shape.h;
  args.w = y.shape.w;
  args.in_c = x.shape.c;
  args.out_c = y.shape.c;
  const std::uint32_t sum = plan_.fused_addition(layer);
  if (sum != kNoIndex) {
    args.y = map(sum + 1).data;
    const Map residual = map(plan_.layer(sum).second_input);
    set_residual(residual.shape, y.shape, residual.data, args);
  }
  return args;
}

kernels::FullyConnectedArgs StepMaker::fully_connected(const LayerRecord& l, Map x, Map y) const {
  auto args = weighted<kernels::FullyConnectedArgs>(l, x, y);
  args.in_elems = vector_elems(x.shape);
  args.out_c = y.shape.c;
  return args;
}

kernels::CausalConvArgs StepMaker::causal_conv(const LayerRecord& l, Map x, Map y,
                                               float* state) const {
  auto args = weighted<kernels::CausalConvArgs>(l, x, y);
  args.previous = state;
  args.in_elems = vector_elems(x.shape);
  args.out_c = y.shape.c;
  return args;
}

kernels::LstmArgs StepMaker::lstm(const LayerRecord& l, Map x, Map y, float* state) const {
  kernels::LstmArgs args{};
  args.x = x.data;
  args.h = state;
  args.c = state + y.shape.c;
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = y.data;
  args.gates = scratch_;
  args.in_elems = vector_elems(x.shape);
  args.hidden = y.shape.c;
  return args;
}

kernels::MaxPoolArgs StepMaker::max_pool(const LayerRecord& l, Map x, Map y) {
  kernels::MaxPoolArgs args{};
  args.x = x.data;
  args.y = y.data;
  args.channels = y.shape.c;
  set_windows(l, x.shape, y.shape, args);
  return args;
}

kernels::ResidualAddArgs StepMaker::add(const LayerRecord& l, Map x, Map y) const {
  kernels::ResidualAddArgs args{};
  args.x = x.data;
  args.y = y.data;
  args.channels = y.shape.c;
  args.h = y.shape.h;
  args.w = y.shape.w;
  const Map residual = map(l.second_input);
  set_residual(residual.shape, y.shape, residual.data, args);
  return args;
}

kernels::CombineArgs StepMaker::combine(kernels::Combination kind, const LayerRecord& l, Map x,
                                        Map y) const {
  const Map second = map(l.second_input);
  return {x.data,
          second.data,
          y.data,
          kind,
          y.shape.h,
          y.shape.w,
          y.shape.c,
          second.shape.h == 1 && y.shape.h > 1,
          second.shape.w == 1 && y.shape.w > 1,
          second.shape.c == 1 && y.shape.c > 1};
}

kernels::ConcatArgs StepMaker::concat(const LayerRecord& l, Map x, Map y) const {
  const Map second = map(l.second_input);
  return {x.data, second.data, y.data, pixels(y.shape), x.shape.c, second.shape.c};
}

kernels::SliceArgs StepMaker::slice(const LayerRecord& l, Map x, Map y) {
  kernels::SliceArgs args{};
  args.x = x.data;
  args.y = y.data;
  args.in_h = x.shape.h;
  args.in_w = x.shape.w;
  args.top = l.pad_top;
  args.left = l.pad_left;
  args.first_channel = l.first_channel;
  args.h = y.shape.h;
  args.w = y.shape.w;
  args.channels = y.shape.c;
  return args;
}

}  // namespace mien::engine
