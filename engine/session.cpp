#include "engine/session.h"

#include <cstring>
#include <type_traits>

#include "engine/arena_plan.h"
#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::engine {

using formats::kNoIndex;
using formats::LayerActivation;
using formats::LayerOp;
using formats::LayerRecord;
using formats::NetworkRecord;

namespace {

constexpr std::size_t kLargestArgs = sizeof(kernels::PointwiseArgs) > sizeof(kernels::Conv2dArgs)
                                         ? sizeof(kernels::PointwiseArgs)
                                         : sizeof(kernels::Conv2dArgs);

std::size_t aligned(std::size_t bytes) {
  return (bytes + kSessionAlignment - 1) / kSessionAlignment * kSessionAlignment;
}

std::size_t elems_of(const Shape& shape, bool is_input) {
  if (is_input && shape.interleaved()) {
    return shape.pixels() * static_cast<std::size_t>(shape.c);
  }
  return blocked_elems(shape);
}

}  // namespace

// A kernel with its arguments. `call` knows the type of both.
struct Session::Step {
  kernels::AnyKernel kernel;
  void (*call)(const Step&);
  alignas(8) std::byte args[kLargestArgs];
};

// Lays out and fills a session. The same walk serves to measure and to build.
class SessionBuilder {
 public:
  explicit SessionBuilder(const SessionRequest& request) : request_(request) {}

  Status plan();
  [[nodiscard]] SessionSize size() const;
  Status build(std::span<std::byte> memory, std::span<std::byte> arena, Session*& session);

 private:
  using Step = Session::Step;

  struct Value {
    Shape shape;
    std::uint32_t last_use = 0;
    bool is_output = false;
    std::uint32_t readers = 0;
    float* data = nullptr;
  };

  Status find_network();
  Status infer();
  void fuse_additions();
  void place_maps();
  [[nodiscard]] std::size_t state_elems(std::uint32_t layer) const;
  [[nodiscard]] std::size_t scratch_elems(std::uint32_t layer) const;

  Status add_step(std::uint32_t layer, Session& session);
  template <class Args>
  Status emit(const Args& args, Session& session);
  [[nodiscard]] kernels::ActivationSpec activation_of(const LayerRecord& layer) const;
  [[nodiscard]] const std::uint16_t* halves(std::uint32_t tensor) const;
  Status conv2d(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status depthwise(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status pointwise(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status fully_connected(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status causal_conv(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status lstm(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status max_pool(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status add(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status activate(const LayerRecord& layer, std::uint32_t index, Session& session);
  Status softmax(const LayerRecord& layer, std::uint32_t index, Session& session);

  [[nodiscard]] std::uint32_t layer_count() const {
    return static_cast<std::uint32_t>(layers_.size());
  }
  [[nodiscard]] Value& result(std::uint32_t layer) { return values_[layer + 1]; }

  SessionRequest request_;
  const NetworkRecord* network_ = nullptr;
  std::span<const LayerRecord> layers_;
  Value values_[formats::kMaxLayers + 1];
  // Layer whose addition the layer performs itself, or kNoIndex; and the layers that vanish by
  // that.
  std::uint32_t fused_addition_[formats::kMaxLayers];
  bool vanished_[formats::kMaxLayers] = {};
  Interval intervals_[formats::kMaxLayers];
  std::uint32_t interval_value_[formats::kMaxLayers];
  std::uint32_t interval_count_ = 0;
  std::size_t arena_bytes_ = 0;
  std::size_t scratch_offset_ = 0;
  std::size_t state_elems_ = 0;
  float* state_ = nullptr;    // of the next temporal layer
  float* scratch_ = nullptr;  // in the arena, for the step that runs
};

Status SessionBuilder::find_network() {
  network_ = request_.model->network(request_.network);
  if (network_ == nullptr) {
    return Status::kNoSuchNetwork;
  }
  layers_ = request_.model->file().layers(*network_);
  const Shape declared = input_shape(*network_);
  if (request_.input == Shape{}) {
    request_.input = declared;
  }
  const bool any_size = (network_->flags & formats::kAnySize) != 0;
  const Shape& input = request_.input;
  const bool fits = any_size ? input.c == declared.c && input.h >= declared.h &&
                                   input.w >= declared.w && input.h <= 1 << 14 && input.w <= 1 << 14
                             : input == declared;
  return fits ? Status::kOk : Status::kWrongInput;
}

Status SessionBuilder::infer() {
  ShapeWalk walk(layers_, request_.input);
  values_[0].shape = request_.input;
  while (walk.next()) {
    const std::uint32_t i = walk.index();
    const LayerRecord& layer = layers_[i];
    values_[i + 1].shape = walk.output();
    values_[i + 1].last_use = i;
    const std::uint32_t read[2] = {layer.input, layer.second_input};
    for (const std::uint32_t value : read) {
      if (value != kNoIndex) {
        values_[value].last_use = i;
        ++values_[value].readers;
      }
    }
    const bool reads_image = layer.input == 0 || layer.second_input == 0;
    if (reads_image && request_.input.interleaved() &&
        layer.op != static_cast<std::uint16_t>(LayerOp::kConv2d)) {
      return Status::kUnsupportedLayout;
    }
  }
  for (std::uint32_t i = 0; i < network_->output_count; ++i) {
    values_[network_->outputs[i]].is_output = true;
  }
  return walk.status();
}

// A pointwise layer adds the residual itself when nothing else looks at its result.
void SessionBuilder::fuse_additions() {
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    fused_addition_[i] = kNoIndex;
  }
  for (std::uint32_t i = 1; i < layer_count(); ++i) {
    const LayerRecord& sum = layers_[i];
    const LayerRecord& before = layers_[i - 1];
    const bool adds_it = sum.op == static_cast<std::uint16_t>(LayerOp::kAdd) && sum.input == i &&
                         sum.second_input != i;
    const bool alone = values_[i].readers == 1 && !values_[i].is_output;
    if (adds_it && alone && before.op == static_cast<std::uint16_t>(LayerOp::kPointwise)) {
      fused_addition_[i - 1] = i;
      vanished_[i] = true;
    }
  }
}

std::size_t SessionBuilder::state_elems(std::uint32_t layer) const {
  const Shape& input = values_[layers_[layer].input].shape;
  const Shape& output = values_[layer + 1].shape;
  switch (static_cast<LayerOp>(layers_[layer].op)) {
    case LayerOp::kCausalConv:
      return blocked_elems(input);
    case LayerOp::kLstm:
      return 2 * blocked_elems(output);
    default:
      return 0;
  }
}

std::size_t SessionBuilder::scratch_elems(std::uint32_t layer) const {
  const bool is_lstm = layers_[layer].op == static_cast<std::uint16_t>(LayerOp::kLstm);
  return is_lstm ? 4 * blocked_elems(values_[layer + 1].shape) : 0;
}

// Maps in between go to the arena; input and outputs stay with the session.
void SessionBuilder::place_maps() {
  std::size_t scratch = 0;
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    state_elems_ += state_elems(i);
    scratch = scratch_elems(i) > scratch ? scratch_elems(i) : scratch;
    const bool elsewhere = vanished_[i] || values_[i + 1].is_output;
    const std::uint32_t stands_for = fused_addition_[i];
    const std::uint32_t value = stands_for == kNoIndex ? i + 1 : stands_for + 1;
    if (elsewhere || values_[value].is_output) {
      continue;
    }
    interval_value_[interval_count_] = value;
    intervals_[interval_count_++] = {blocked_elems(values_[value].shape) * sizeof(float), i,
                                     values_[value].last_use, 0};
  }
  scratch_offset_ = aligned(place(intervals_, interval_count_));
  arena_bytes_ = scratch_offset_ + aligned(scratch * sizeof(float));
}

Status SessionBuilder::plan() {
  Status status = find_network();
  if (status != Status::kOk) {
    return status;
  }
  status = infer();
  if (status != Status::kOk) {
    return status;
  }
  fuse_additions();
  place_maps();
  return Status::kOk;
}

SessionSize SessionBuilder::size() const {
  std::size_t bytes = aligned(sizeof(Session)) + aligned(layers_.size() * sizeof(Step)) +
                      aligned(elems_of(request_.input, true) * sizeof(float)) +
                      aligned(state_elems_ * sizeof(float));
  for (std::uint32_t i = 0; i < network_->output_count; ++i) {
    bytes += aligned(blocked_elems(values_[network_->outputs[i]].shape) * sizeof(float));
  }
  return {bytes, arena_bytes_};
}

Status SessionBuilder::build(std::span<std::byte> memory, std::span<std::byte> arena,
                             Session*& session) {
  const SessionSize needed = size();
  const auto address = [](const void* p) { return reinterpret_cast<std::uintptr_t>(p); };
  if (memory.size() < needed.session_bytes || arena.size() < needed.arena_bytes) {
    return Status::kMemoryTooSmall;
  }
  if (address(memory.data()) % kSessionAlignment != 0 ||
      address(arena.data()) % kSessionAlignment != 0) {
    return Status::kMisaligned;
  }
  std::memset(memory.data(), 0, needed.session_bytes);
  std::byte* at = memory.data();
  const auto take = [&](std::size_t bytes) {
    std::byte* taken = at;
    at += aligned(bytes);
    return taken;
  };
  const auto take_floats = [&](std::size_t elems) {
    return std::span(reinterpret_cast<float*>(take(elems * sizeof(float))), elems);
  };
  auto* made = new (take(sizeof(Session))) Session();
  made->steps_ = reinterpret_cast<Step*>(take(layers_.size() * sizeof(Step)));
  made->input_shape_ = request_.input;
  made->input_ = take_floats(elems_of(request_.input, true));
  values_[0].data = made->input_.data();
  made->output_count_ = network_->output_count;
  for (std::uint32_t i = 0; i < network_->output_count; ++i) {
    Value& value = values_[network_->outputs[i]];
    const std::span<float> own = take_floats(blocked_elems(value.shape));
    value.data = value.data == nullptr ? own.data() : value.data;
    made->outputs_[i] = {value.data, own.size()};
    made->output_shapes_[i] = value.shape;
  }
  made->state_ = take_floats(state_elems_);
  state_ = made->state_.data();
  for (std::uint32_t i = 0; i < interval_count_; ++i) {
    values_[interval_value_[i]].data =
        reinterpret_cast<float*>(arena.data() + intervals_[i].offset);
  }
  scratch_ = reinterpret_cast<float*>(arena.data() + scratch_offset_);
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    const Status status = vanished_[i] ? Status::kOk : add_step(i, *made);
    if (status != Status::kOk) {
      return status;
    }
  }
  session = made;
  return Status::kOk;
}

template <class Args>
Status SessionBuilder::emit(const Args& args, Session& session) {
  static_assert(sizeof(Args) <= kLargestArgs && std::is_trivially_copyable_v<Args>);
  const kernels::AnyKernel kernel = kernels::find_any(Args::kFamily, request_.cpu_mask);
  if (kernel == nullptr) {
    return Status::kNoKernel;
  }
  Step& step = session.steps_[session.step_count_++];
  step.kernel = kernel;
  step.call = [](const Step& self) {
    reinterpret_cast<kernels::Kernel<Args>>(self.kernel)(*reinterpret_cast<const Args*>(self.args));
  };
  std::memcpy(step.args, &args, sizeof args);
  return Status::kOk;
}

const std::uint16_t* SessionBuilder::halves(std::uint32_t tensor) const {
  if (tensor == kNoIndex) {
    return nullptr;
  }
  const formats::FileView& file = request_.model->file();
  return reinterpret_cast<const std::uint16_t*>(file.data(file.tensors()[tensor]).data());
}

kernels::ActivationSpec SessionBuilder::activation_of(const LayerRecord& layer) const {
  using kernels::Activation;
  const auto kind = [&] {
    switch (static_cast<LayerActivation>(layer.activation)) {
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
    }
    return Activation::kNone;
  };
  return {kind(), layer.alpha, halves(layer.slopes)};
}

Status SessionBuilder::add_step(std::uint32_t index, Session& session) {
  const LayerRecord& layer = layers_[index];
  switch (static_cast<LayerOp>(layer.op)) {
    case LayerOp::kConv2d:
      return conv2d(layer, index, session);
    case LayerOp::kDepthwise:
      return depthwise(layer, index, session);
    case LayerOp::kPointwise:
      return pointwise(layer, index, session);
    case LayerOp::kFullyConnected:
      return fully_connected(layer, index, session);
    case LayerOp::kCausalConv:
      return causal_conv(layer, index, session);
    case LayerOp::kLstm:
      return lstm(layer, index, session);
    case LayerOp::kMaxPool:
      return max_pool(layer, index, session);
    case LayerOp::kAdd:
      return add(layer, index, session);
    case LayerOp::kActivation:
      return activate(layer, index, session);
    case LayerOp::kSoftmax:
      return softmax(layer, index, session);
  }
  return Status::kNoKernel;
}

Status SessionBuilder::conv2d(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& x = values_[l.input];
  const Value& y = result(index);
  kernels::Conv2dArgs args{};
  args.x = x.data;
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = y.data;
  args.activation = activation_of(l);
  args.in_h = x.shape.h;
  args.in_w = x.shape.w;
  args.in_c = x.shape.c;
  args.x_pixel_elems = l.input == 0 && x.shape.interleaved() ? x.shape.c : 8;
  args.out_h = y.shape.h;
  args.out_w = y.shape.w;
  args.out_c = y.shape.c;
  args.kernel_h = l.kernel_height;
  args.kernel_w = l.kernel_width;
  args.stride_h = l.stride_height;
  args.stride_w = l.stride_width;
  args.pad_top = l.pad_top;
  args.pad_left = l.pad_left;
  return emit(args, session);
}

Status SessionBuilder::depthwise(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& x = values_[l.input];
  const Value& y = result(index);
  kernels::DepthwiseArgs args{};
  args.x = x.data;
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = y.data;
  args.activation = activation_of(l);
  args.channels = y.shape.c;
  args.in_h = x.shape.h;
  args.in_w = x.shape.w;
  args.out_h = y.shape.h;
  args.out_w = y.shape.w;
  args.kernel_h = l.kernel_height;
  args.kernel_w = l.kernel_width;
  args.stride_h = l.stride_height;
  args.stride_w = l.stride_width;
  args.pad_top = l.pad_top;
  args.pad_left = l.pad_left;
  return emit(args, session);
}

Status SessionBuilder::pointwise(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& x = values_[l.input];
  const std::uint32_t sum = fused_addition_[index];
  const Value& y = sum == kNoIndex ? result(index) : result(sum);
  kernels::PointwiseArgs args{};
  args.x = x.data;
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = y.data;
  args.activation = activation_of(l);
  args.h = x.shape.h;
  args.w = x.shape.w;
  args.in_c = x.shape.c;
  args.out_c = y.shape.c;
  if (sum != kNoIndex) {
    const Value& residual = values_[layers_[sum].second_input];
    args.residual = residual.data;
    args.residual_h = residual.shape.h;
    args.residual_w = residual.shape.w;
    args.residual_top = (residual.shape.h - y.shape.h) / 2;
    args.residual_left = (residual.shape.w - y.shape.w) / 2;
  }
  return emit(args, session);
}

Status SessionBuilder::fully_connected(const LayerRecord& l, std::uint32_t index,
                                       Session& session) {
  const Value& x = values_[l.input];
  kernels::FullyConnectedArgs args{};
  args.x = x.data;
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = result(index).data;
  args.activation = activation_of(l);
  args.in_elems = static_cast<std::int32_t>(blocked_elems(x.shape));
  args.out_c = result(index).shape.c;
  return emit(args, session);
}

Status SessionBuilder::causal_conv(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& x = values_[l.input];
  kernels::CausalConvArgs args{};
  args.x = x.data;
  args.previous = state_;
  state_ += state_elems(index);
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = result(index).data;
  args.activation = activation_of(l);
  args.in_elems = static_cast<std::int32_t>(blocked_elems(x.shape));
  args.out_c = result(index).shape.c;
  return emit(args, session);
}

Status SessionBuilder::lstm(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& x = values_[l.input];
  const std::int32_t hidden = result(index).shape.c;
  kernels::LstmArgs args{};
  args.x = x.data;
  args.h = state_;
  args.c = state_ + hidden;
  state_ += state_elems(index);
  args.weights = halves(l.weights);
  args.bias = halves(l.bias);
  args.y = result(index).data;
  args.gates = scratch_;
  args.in_elems = static_cast<std::int32_t>(blocked_elems(x.shape));
  args.hidden = hidden;
  return emit(args, session);
}

Status SessionBuilder::max_pool(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& x = values_[l.input];
  const Value& y = result(index);
  kernels::MaxPoolArgs args{};
  args.x = x.data;
  args.y = y.data;
  args.channels = y.shape.c;
  args.in_h = x.shape.h;
  args.in_w = x.shape.w;
  args.out_h = y.shape.h;
  args.out_w = y.shape.w;
  args.kernel_h = l.kernel_height;
  args.kernel_w = l.kernel_width;
  args.stride_h = l.stride_height;
  args.stride_w = l.stride_width;
  args.pad_top = l.pad_top;
  args.pad_left = l.pad_left;
  return emit(args, session);
}

Status SessionBuilder::add(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& residual = values_[l.second_input];
  const Value& y = result(index);
  kernels::ResidualAddArgs args{};
  args.x = values_[l.input].data;
  args.residual = residual.data;
  args.y = y.data;
  args.channels = y.shape.c;
  args.h = y.shape.h;
  args.w = y.shape.w;
  args.residual_h = residual.shape.h;
  args.residual_w = residual.shape.w;
  args.residual_top = (residual.shape.h - y.shape.h) / 2;
  args.residual_left = (residual.shape.w - y.shape.w) / 2;
  return emit(args, session);
}

Status SessionBuilder::activate(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& y = result(index);
  return emit(kernels::ActivateArgs{values_[l.input].data, y.data, activation_of(l),
                                    static_cast<std::int32_t>(y.shape.pixels()), y.shape.c},
              session);
}

Status SessionBuilder::softmax(const LayerRecord& l, std::uint32_t index, Session& session) {
  const Value& y = result(index);
  return emit(kernels::SoftmaxArgs{values_[l.input].data, y.data,
                                   static_cast<std::int32_t>(y.shape.pixels()), y.shape.c},
              session);
}

Status session_size(const SessionRequest& request, SessionSize& size) {
  SessionBuilder builder(request);
  const Status status = builder.plan();
  size = status == Status::kOk ? builder.size() : SessionSize{};
  return status;
}

Status Session::init(const SessionRequest& request, std::span<std::byte> memory,
                     std::span<std::byte> arena, Session*& session) {
  session = nullptr;
  SessionBuilder builder(request);
  const Status status = builder.plan();
  return status == Status::kOk ? builder.build(memory, arena, session) : status;
}

void Session::run() {
  for (const Step *step = steps_, *end = steps_ + step_count_; step != end; ++step) {
    step->call(*step);
  }
}

void Session::reset() {
  for (float& one : state_) {
    one = 0.0f;
  }
}

}  // namespace mien::engine
