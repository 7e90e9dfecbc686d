// C API: the networks, layers, metadata and constants of weights.
#include <mien/mien.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/session.h"
#include "tracker/api/versioned_struct.h"
#include "tracker/encoders/weights.h"

namespace {

using mien::formats::FileView;
using mien::formats::LayerActivation;
using mien::formats::LayerOp;
using mien::formats::LayerRecord;
using mien::formats::NetworkRecord;
using mien::formats::TensorRecord;

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

std::uint64_t tensor_bytes(const FileView& file, const LayerRecord& layer) {
  std::uint64_t bytes = 0;
  for (const std::uint32_t tensor : {layer.weights, layer.bias, layer.slopes}) {
    bytes += tensor == mien::formats::kNoIndex ? 0 : file.tensors()[tensor].bytes;
  }
  return bytes;
}

bool is_constant(const TensorRecord& tensor) { return tensor.name.bytes != 0; }

mien_shape shape_of(const mien::engine::Shape& shape) { return {shape.h, shape.w, shape.c}; }

template <std::size_t N>
void write_name(std::string_view name, char (&to)[N]) {
  to[std::min(name.copy(to, N - 1), N - 1)] = '\0';
}

std::int32_t count_networks(const FileView& file) {
  return static_cast<std::int32_t>(file.networks().size());
}
std::int32_t count_metadata(const FileView& file) {
  return static_cast<std::int32_t>(file.metadata().size());
}
std::int32_t count_constants(const FileView& file) {
  const auto tensors = file.tensors();
  return static_cast<std::int32_t>(std::count_if(tensors.begin(), tensors.end(), is_constant));
}

using Count = std::int32_t (*)(const FileView&);

std::int32_t count_all(const mien_weights* weights, Count count) {
  std::int32_t all = 0;
  for (std::size_t i = 0; weights != nullptr && i < weights->count; ++i) {
    all += count(weights->files[i].model.file());
  }
  return all;
}

// The file of the entry with this index, which becomes that in the file; nullptr outside the range.
const mien_weights::File* file_with(const mien_weights& weights, Count count, std::int32_t& index) {
  for (const mien_weights::File& file : weights) {
    const std::int32_t entries = count(file.model.file());
    if (index >= 0 && index < entries) {
      return &file;
    }
    index -= entries;
  }
  return nullptr;
}

const NetworkRecord* network_at(const mien_weights& weights, std::int32_t index,
                                const mien_weights::File*& file) {
  file = file_with(weights, count_networks, index);
  return file == nullptr ? nullptr
                         : &file->model.file().networks()[static_cast<std::size_t>(index)];
}

template <class Info>
mien_status write(const Info& info, Info* to) {
  return mien::tracker::write_struct(info, MIEN_SIZE_THROUGH(Info, struct_size), to)
             ? MIEN_OK
             : MIEN_ERROR_STRUCT_SIZE;
}

mien_network_info describe(const mien_weights::File& file, const NetworkRecord& record) {
  const FileView& view = file.model.file();
  const mien::engine::Shape input = mien::engine::input_shape(record);
  mien_network_info info = {};
  info.file = file.index;
  write_name(view.text(record.name), info.name);
  info.input = shape_of(input);
  info.any_size = (record.flags & mien::formats::kAnySize) != 0 ? 1 : 0;
  info.layers = static_cast<std::int32_t>(record.layer_count);
  info.outputs = static_cast<std::int32_t>(record.output_count);
  const mien::engine::LayerCost cost = mien::engine::network_cost(view.layers(record), input);
  info.parameters = cost.parameters;
  info.macs = cost.macs;
  for (const LayerRecord& layer : view.layers(record)) {
    info.weight_bytes += tensor_bytes(view, layer);
  }
  mien_network_config config;
  mien_network_config_default(&config);
  mien::engine::SessionSize size;
  if (mien::engine::session_size({&file.model, view.text(record.name), {}, config.cpu_mask},
                                 size) == MIEN_OK) {
    info.session_bytes = size.session_bytes;
    info.arena_bytes = size.arena_bytes;
  }
  return info;
}

mien_layer_info describe_layer(const FileView& file, const NetworkRecord& network,
                               std::uint32_t index) {
  const auto layers = file.layers(network);
  mien::engine::ShapeWalk walk(layers, mien::engine::input_shape(network));
  while (walk.next() && walk.index() < index) {
  }
  const LayerRecord& layer = layers[index];
  const mien::engine::LayerCost cost = mien::engine::layer_cost(layer, walk.input(), walk.output());
  const bool second = layer.second_input != mien::formats::kNoIndex;
  mien_layer_info info = {};
  info.input = static_cast<std::int32_t>(layer.input);
  info.second_input = second ? static_cast<std::int32_t>(layer.second_input) : -1;
  info.output = shape_of(walk.output());
  info.op = op_name(layer.op);
  info.activation = activation_name(layer.activation);
  info.kernel[0] = layer.kernel_height;
  info.kernel[1] = layer.kernel_width;
  info.stride[0] = layer.stride_height;
  info.stride[1] = layer.stride_width;
  info.padding[0] = layer.pad_top;
  info.padding[1] = layer.pad_left;
  info.padding[2] = layer.pad_bottom;
  info.padding[3] = layer.pad_right;
  info.first_channel = layer.first_channel;
  info.input_bound = layer.input_bound;
  info.parameters = cost.parameters;
  info.macs = cost.macs;
  return info;
}

// The constant with this index in its file.
const TensorRecord& constant_at(const FileView& file, std::int32_t index) {
  const TensorRecord* tensor = file.tensors().data();
  for (;; ++tensor) {
    if (is_constant(*tensor) && index-- == 0) {
      return *tensor;
    }
  }
}

}  // namespace

int32_t mien_weights_network_count(const mien_weights* weights) {
  return count_all(weights, count_networks);
}

mien_status mien_weights_network(const mien_weights* weights, int32_t network,
                                 mien_network_info* info) {
  if (weights == nullptr || info == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien_weights::File* file = nullptr;
  const NetworkRecord* record = network_at(*weights, network, file);
  return record != nullptr ? write(describe(*file, *record), info) : MIEN_ERROR_OUT_OF_RANGE;
}

mien_status mien_weights_layer(const mien_weights* weights, int32_t network, int32_t layer,
                               mien_layer_info* info) {
  if (weights == nullptr || info == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien_weights::File* file = nullptr;
  const NetworkRecord* record = network_at(*weights, network, file);
  const auto index = static_cast<std::uint32_t>(layer);
  if (record == nullptr || layer < 0 || index >= record->layer_count) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  return write(describe_layer(file->model.file(), *record, index), info);
}

int32_t mien_weights_metadata_count(const mien_weights* weights) {
  return count_all(weights, count_metadata);
}

mien_status mien_weights_metadata(const mien_weights* weights, int32_t index,
                                  mien_metadata_info* info) {
  if (weights == nullptr || info == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien_weights::File* file = file_with(*weights, count_metadata, index);
  if (file == nullptr) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  const FileView& view = file->model.file();
  const auto& record = view.metadata()[static_cast<std::size_t>(index)];
  mien_metadata_info entry = {};
  entry.file = file->index;
  write_name(view.text(record.key), entry.key);
  entry.value = view.text(record.value).data();
  entry.value_bytes = record.value.bytes;
  return write(entry, info);
}

int32_t mien_weights_constant_count(const mien_weights* weights) {
  return count_all(weights, count_constants);
}

mien_status mien_weights_constant(const mien_weights* weights, int32_t index,
                                  mien_constant_info* info) {
  if (weights == nullptr || info == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien_weights::File* file = file_with(*weights, count_constants, index);
  if (file == nullptr) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  const TensorRecord& tensor = constant_at(file->model.file(), index);
  mien_constant_info constant = {};
  constant.file = file->index;
  write_name(file->model.file().text(tensor.name), constant.name);
  const bool half = tensor.type == static_cast<std::uint16_t>(mien::formats::DataType::kFloat16);
  constant.type = half ? "fp16" : "fp32";
  constant.rank = static_cast<std::int32_t>(tensor.rank);
  std::copy_n(tensor.dims, 4, constant.dims);
  return write(constant, info);
}
