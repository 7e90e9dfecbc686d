// Implements include/mien/engine.h with Model and Session.
#include <mien/engine.h>

#include <cstdlib>
#include <new>
#include <type_traits>

#include "engine/session.h"
#include "kernels/families.h"
#include "kernels/float_mode.h"
#include "kernels/registry.h"

namespace mien {

using engine::Model;
using engine::Session;
using formats::LayerActivation;
using formats::LayerOp;

namespace {

static_assert(static_cast<int>(EngineStatus::kOutOfMemory) ==
              static_cast<int>(engine::Status::kOutOfMemory));

EngineStatus to_public(engine::Status status) { return static_cast<EngineStatus>(status); }

TensorShape to_public(const engine::Shape& shape) { return {shape.h, shape.w, shape.c}; }

const char* op_name(std::uint16_t op) {
  switch (static_cast<LayerOp>(op)) {
    case LayerOp::kConv2d:
      return "conv2d";
    case LayerOp::kDepthwise:
      return "depthwise";
    case LayerOp::kPointwise:
      return "pointwise";
    case LayerOp::kFullyConnected:
      return "fully_connected";
    case LayerOp::kCausalConv:
      return "causal_conv";
    case LayerOp::kLstm:
      return "lstm";
    case LayerOp::kMaxPool:
      return "max_pool";
    case LayerOp::kAdd:
      return "add";
    case LayerOp::kActivation:
      return "activation";
    case LayerOp::kSoftmax:
      return "softmax";
    case LayerOp::kGlobalAveragePool:
      return "global_average_pool";
    case LayerOp::kConcat:
      return "concat";
    case LayerOp::kSlice:
      return "slice";
    case LayerOp::kMultiply:
      return "multiply";
    case LayerOp::kDivide:
      return "divide";
    case LayerOp::kBroadcastAdd:
      return "broadcast_add";
    case LayerOp::kResize:
      return "resize";
    case LayerOp::kRearrange:
      return "rearrange";
    case LayerOp::kNormalize:
      return "normalize";
  }
  return "";
}

const char* activation_name(std::uint16_t activation) {
  switch (static_cast<LayerActivation>(activation)) {
    case LayerActivation::kNone:
      return "none";
    case LayerActivation::kRelu:
      return "relu";
    case LayerActivation::kRelu6:
      return "relu6";
    case LayerActivation::kLeakyRelu:
      return "leaky_relu";
    case LayerActivation::kPrelu:
      return "prelu";
    case LayerActivation::kSigmoid:
      return "sigmoid";
    case LayerActivation::kTanh:
      return "tanh";
    case LayerActivation::kClamp01:
      return "clamp01";
    case LayerActivation::kHardSwish:
      return "hard_swish";
    case LayerActivation::kSwish:
      return "swish";
    case LayerActivation::kGelu:
      return "gelu";
    case LayerActivation::kGeluTanh:
      return "gelu_tanh";
    case LayerActivation::kErf:
      return "erf";
    case LayerActivation::kExp:
      return "exp";
    case LayerActivation::kSqrt:
      return "sqrt";
  }
  return "";
}

std::uint64_t tensor_bytes(const formats::FileView& file, const formats::LayerRecord& layer) {
  std::uint64_t bytes = 0;
  for (const std::uint32_t tensor : {layer.weights, layer.bias, layer.slopes}) {
    bytes += tensor == formats::kNoIndex ? 0 : file.tensors()[tensor].bytes;
  }
  return bytes;
}

const formats::TensorRecord* constant_at(const formats::FileView& file, std::int32_t index) {
  for (const formats::TensorRecord& tensor : file.tensors()) {
    if (tensor.name.bytes != 0 && index-- == 0) {
      return &tensor;
    }
  }
  return nullptr;
}

#ifdef _WIN32  // no aligned_alloc in its C library
void* aligned_memory(std::size_t alignment, std::size_t bytes) {
  return _aligned_malloc(bytes, alignment);
}
void release_aligned(void* memory) { _aligned_free(memory); }
#else
void* aligned_memory(std::size_t alignment, std::size_t bytes) {
  return std::aligned_alloc(alignment, bytes);
}
void release_aligned(void* memory) { std::free(memory); }
#endif

void* allocate(const mien_allocator& allocator, std::size_t bytes) {
  constexpr std::size_t kAlignment = engine::kSessionAlignment;
  const std::size_t rounded = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  return allocator.allocate != nullptr ? allocator.allocate(allocator.user, rounded, kAlignment)
                                       : aligned_memory(kAlignment, rounded);
}

Model& model_in(std::byte* storage) { return *std::launder(reinterpret_cast<Model*>(storage)); }
const Model& model_in(const std::byte* storage) {
  return *std::launder(reinterpret_cast<const Model*>(storage));
}

engine::SessionRequest request_of(const Model& model, std::string_view network,
                                  const NetworkRunner::Options& options) {
  const TensorShape& input = options.input;
  return {&model, network, {input.height, input.width, input.channels}, options.cpu_mask};
}

Session& session_in(void* session) { return *static_cast<Session*>(session); }

}  // namespace

const char* message(EngineStatus status) {
  return engine::message(static_cast<engine::Status>(status));
}

WeightFile::WeightFile() {
  static_assert(sizeof(Model) <= sizeof model_ && alignof(Model) <= 8);
  // WeightFile copies and destroys the model as plain bytes.
  static_assert(std::is_trivially_copyable_v<Model> && std::is_trivially_destructible_v<Model>);
  new (model_) Model();
}

EngineStatus WeightFile::open(std::span<const std::byte> bytes) {
  formats::Validation fault;
  const engine::Status status = model_in(model_).open(bytes, &fault);
  fault_ = formats::message(fault.status);
  fault_offset_ = fault.offset;
  return to_public(status);
}

std::int32_t WeightFile::network_count() const {
  return static_cast<std::int32_t>(model_in(model_).file().networks().size());
}

NetworkInfo WeightFile::network(std::int32_t index) const {
  const Model& model = model_in(model_);
  const formats::FileView& file = model.file();
  const formats::NetworkRecord& record = file.networks()[static_cast<std::size_t>(index)];
  NetworkInfo info;
  info.name = file.text(record.name);
  info.input = to_public(engine::input_shape(record));
  info.any_size = (record.flags & formats::kAnySize) != 0;
  info.layers = static_cast<std::int32_t>(record.layer_count);
  info.outputs = static_cast<std::int32_t>(record.output_count);
  const engine::LayerCost cost =
      engine::network_cost(file.layers(record), engine::input_shape(record));
  info.parameters = cost.parameters;
  info.macs = cost.macs;
  for (const formats::LayerRecord& layer : file.layers(record)) {
    info.weight_bytes += tensor_bytes(file, layer);
  }
  engine::SessionSize size;
  const std::uint32_t cpu_mask = NetworkRunner::Options().cpu_mask;
  if (engine::session_size({&model, info.name, {}, cpu_mask}, size) == engine::Status::kOk) {
    info.session_bytes = size.session_bytes;
    info.arena_bytes = size.arena_bytes;
  }
  return info;
}

LayerInfo WeightFile::layer(std::int32_t network, std::int32_t index) const {
  const formats::FileView& file = model_in(model_).file();
  const formats::NetworkRecord& record = file.networks()[static_cast<std::size_t>(network)];
  const auto layers = file.layers(record);
  engine::ShapeWalk walk(layers, engine::input_shape(record));
  LayerInfo info;
  while (walk.next() && walk.index() < static_cast<std::uint32_t>(index)) {
  }
  const formats::LayerRecord& layer = layers[static_cast<std::size_t>(index)];
  const engine::LayerCost cost = engine::layer_cost(layer, walk.input(), walk.output());
  info.op = op_name(layer.op);
  info.activation = activation_name(layer.activation);
  info.output = to_public(walk.output());
  info.input = static_cast<std::int32_t>(layer.input);
  info.second_input =
      layer.second_input == formats::kNoIndex ? -1 : static_cast<std::int32_t>(layer.second_input);
  info.kernel[0] = layer.kernel_height;
  info.kernel[1] = layer.kernel_width;
  info.stride[0] = layer.stride_height;
  info.stride[1] = layer.stride_width;
  info.padding[0] = layer.pad_top;
  info.padding[1] = layer.pad_left;
  info.padding[2] = layer.pad_bottom;
  info.padding[3] = layer.pad_right;
  info.first_channel = layer.first_channel;
  info.parameters = cost.parameters;
  info.macs = cost.macs;
  return info;
}

std::int32_t WeightFile::metadata_count() const {
  return static_cast<std::int32_t>(model_in(model_).file().metadata().size());
}

MetadataInfo WeightFile::metadata(std::int32_t index) const {
  const formats::FileView& file = model_in(model_).file();
  const formats::MetadataRecord& record = file.metadata()[static_cast<std::size_t>(index)];
  return {file.text(record.key), file.text(record.value)};
}

std::int32_t WeightFile::constant_count() const {
  const formats::FileView& file = model_in(model_).file();
  std::int32_t count = 0;
  while (constant_at(file, count) != nullptr) {
    ++count;
  }
  return count;
}

ConstantInfo WeightFile::constant(std::int32_t index) const {
  const formats::FileView& file = model_in(model_).file();
  const formats::TensorRecord* tensor = constant_at(file, index);
  if (tensor == nullptr) {
    return {};
  }
  const bool half = tensor->type == static_cast<std::uint16_t>(formats::DataType::kFloat16);
  return {file.text(tensor->name), half ? "fp16" : "fp32", {tensor->dims, tensor->rank}};
}

std::size_t WeightFile::file_bytes() const { return model_in(model_).file().file_bytes(); }

EngineStatus NetworkRunner::required_memory(const WeightFile& file, std::string_view network,
                                            const Options& options, RunnerMemory& memory) {
  engine::SessionSize size;
  const engine::Status status =
      engine::session_size(request_of(model_in(file.model_), network, options), size);
  memory = {size.session_bytes, size.arena_bytes};
  return to_public(status);
}

EngineStatus NetworkRunner::create_in(const WeightFile& file, std::string_view network,
                                      const Options& options, std::span<std::byte> session,
                                      std::span<std::byte> arena) {
  release();
  Session* created = nullptr;
  const kernels::FloatMode ours;  // because init may quantize weights
  const engine::Status status =
      Session::init(request_of(model_in(file.model_), network, options), session, arena, created);
  session_ = created;
  return to_public(status);
}

EngineStatus NetworkRunner::create(const WeightFile& file, std::string_view network,
                                   const Options& options) {
  release();
  RunnerMemory needed;
  EngineStatus status = required_memory(file, network, options, needed);
  if (status != EngineStatus::kOk) {
    return status;
  }
  auto* memory =
      static_cast<std::byte*>(allocate(options.allocator, needed.session + needed.arena));
  if (memory == nullptr) {
    return EngineStatus::kOutOfMemory;
  }
  status = create_in(file, network, options, {memory, needed.session},
                     {memory + needed.session, needed.arena});
  allocator_ = options.allocator;
  memory_ = memory;
  if (status != EngineStatus::kOk) {
    release();
  }
  return status;
}

void NetworkRunner::release() {
  if (memory_ != nullptr) {
    allocator_.release != nullptr ? allocator_.release(allocator_.user, memory_)
                                  : release_aligned(memory_);
  }
  memory_ = nullptr;
  session_ = nullptr;
}

NetworkRunner::~NetworkRunner() { release(); }

std::span<float> NetworkRunner::input() { return session_in(session_).input(); }

TensorShape NetworkRunner::input_shape() const {
  return to_public(session_in(session_).input_shape());
}

void NetworkRunner::run() {
  const kernels::FloatMode ours;
  session_in(session_).run();
}

std::int32_t NetworkRunner::step_count() const {
  return static_cast<std::int32_t>(session_in(session_).step_count());
}

NetworkRunner::StepLayers NetworkRunner::step_layers(std::int32_t step) const {
  const auto layers = session_in(session_).step_layers(static_cast<std::uint32_t>(step));
  return {static_cast<std::int32_t>(layers.first), static_cast<std::int32_t>(layers.count)};
}

void NetworkRunner::run_step(std::int32_t step) {
  const kernels::FloatMode ours;
  session_in(session_).run_step(static_cast<std::uint32_t>(step));
}

std::int32_t NetworkRunner::output_count() const {
  return static_cast<std::int32_t>(session_in(session_).output_count());
}

std::span<const float> NetworkRunner::output(std::int32_t index) const {
  return session_in(session_).output(static_cast<std::uint32_t>(index));
}

TensorShape NetworkRunner::output_shape(std::int32_t index) const {
  return to_public(session_in(session_).output_shape(static_cast<std::uint32_t>(index)));
}

void NetworkRunner::reset() { session_in(session_).reset(); }

std::int64_t run_fma_loop(std::uint32_t cpu_mask, std::int64_t rounds) {
  const kernels::Kernel<kernels::FmaPeakArgs> loop = kernels::find<kernels::FmaPeakArgs>(cpu_mask);
  if (loop == nullptr) {
    return 0;
  }
  float sums[8];
  std::int64_t macs = 0;
  const kernels::FloatMode ours;
  loop({sums, rounds, &macs});
  // Using the sums keeps the compiler from removing the loop.
  return sums[0] > -1e30f ? macs : 0;
}

}  // namespace mien
