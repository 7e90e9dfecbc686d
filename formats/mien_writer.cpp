// Builds networks layer by layer.
#include "formats/mien_writer.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "formats/writer_bytes.h"

namespace mien::formats {
namespace {

// Whether the array has the shape [dims..., 1, ..., 1] and is not empty.
bool has_shape(const Array& array, std::initializer_list<std::uint64_t> dims) {
  if (array.shape.size() < dims.size() || array.values.empty() ||
      array.values.size() != count_of(array.shape)) {
    return false;
  }
  return std::equal(dims.begin(), dims.end(), array.shape.begin()) &&
         std::all_of(array.shape.begin() + static_cast<std::ptrdiff_t>(dims.size()),
                     array.shape.end(), [](std::uint32_t dim) { return dim == 1; });
}

std::uint32_t dim(const Array& array, std::size_t i) {
  return i < array.shape.size() ? array.shape[i] : 0;
}

void set_margins(LayerRecord* record, const Padding& padding) {
  record->pad_top = padding.top;
  record->pad_left = padding.left;
  record->pad_bottom = padding.bottom;
  record->pad_right = padding.right;
}

}  // namespace

NetworkWriter::NetworkWriter(std::string name, InputShape input, bool any_size)
    : name_(std::move(name)) {
  record_.input_height = input.height;
  record_.input_width = input.width;
  record_.input_channels = input.channels;
  record_.flags = any_size ? kAnySize : 0;
  require(shape_allowed(shape_of_value(0)), MIEN_ERROR_WEIGHTS_NETWORK);
}

bool NetworkWriter::require(bool condition, mien_status status) {
  if (!condition && status_ == MIEN_OK) {
    status_ = status;
  }
  return condition;
}

ValueShape NetworkWriter::shape_of_value(LayerIndex value) {
  if (value == 0) {
    return {record_.input_height, record_.input_width, record_.input_channels};
  }
  return require(value <= layers_.size(), MIEN_ERROR_WEIGHTS_LAYER_INPUT)
             ? shape_of(layers_[value - 1].record)
             : ValueShape{};
}

NetworkWriter::Layer NetworkWriter::begin(LayerOp op, LayerIndex x, const LayerOptions& options) {
  Layer layer{};
  layer.record.op = static_cast<std::uint16_t>(op);
  layer.record.activation = static_cast<std::uint16_t>(options.activation);
  layer.record.alpha = options.alpha;
  layer.record.input_bound = options.input_bound;
  layer.record.input = x;
  layer.record.second_input = kNoIndex;
  layer.record.weights = layer.record.bias = layer.record.slopes = kNoIndex;
  layer.record.channels = static_cast<std::uint32_t>(shape_of_value(x).channels);
  return layer;
}

void NetworkWriter::set_window(LayerRecord* record, std::uint32_t kernel_h, std::uint32_t kernel_w,
                               const LayerOptions& options) {
  // Saturates, so that a kernel that is too large does not become a valid one.
  record->kernel_height = static_cast<std::uint16_t>(std::min(kernel_h, 0xffffu));
  record->kernel_width = static_cast<std::uint16_t>(std::min(kernel_w, 0xffffu));
  record->stride_height = options.stride_y;
  record->stride_width = options.stride_x;
  set_margins(record, options.padding);
}

// Checks the layer against the format and computes its shape.
bool NetworkWriter::place(LayerRecord* record) {
  const auto value = static_cast<std::uint32_t>(layers_.size() + 1);
  const mien_status status = check_layer(*record, value, record_.flags, kMinorVersion);
  if (!require(status == MIEN_OK, status)) {
    return false;
  }
  const ValueShape input = shape_of_value(record->input);
  const bool two = takes_two(op_of(*record));
  const ValueShape output =
      declared_output_shape(*record, input, two ? shape_of_value(record->second_input) : input);
  const bool declares = op_of(*record) == LayerOp::kResize || op_of(*record) == LayerOp::kRearrange;
  if (!declares) {
    record->height = static_cast<std::uint32_t>(output.height);
    record->width = static_cast<std::uint32_t>(output.width);
  }
  return require(shape_allowed(output), MIEN_ERROR_WEIGHTS_LAYER_SHAPE) && status_ == MIEN_OK;
}

// Keeps invalid layers, so that later values keep their numbers; finish() reports the error.
LayerIndex NetworkWriter::append(Layer layer, const Halves& weights, std::vector<float> bias,
                                 const LayerOptions& options) {
  if (place(&layer.record)) {
    const LayerTensors tensors = tensors_of(layer.record, shape_of_value(layer.record.input));
    const bool gates = op_of(layer.record) == LayerOp::kLstm;
    const std::size_t outputs = layer.record.channels * (gates ? std::size_t{4} : std::size_t{1});
    bias.resize(bias.empty() ? outputs : bias.size());
    require(bias.size() == outputs, MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
    require(options.slopes.size() == (tensors.slopes.dims.rank == 0 ? 0 : layer.record.channels),
            MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
    layer.weights = tensor(tensors.weights.dims, weights);
    layer.bias = tensor(tensors.bias.dims, pack_vector(bias));
    layer.slopes = tensor(tensors.slopes.dims, pack_vector(options.slopes));
  }
  layers_.push_back(std::move(layer));
  return static_cast<LayerIndex>(layers_.size());
}

// `dims` of rank 0 stands for no tensor.
NetworkWriter::Tensor NetworkWriter::tensor(const TensorDims& dims, const Halves& halves) {
  if (dims.rank == 0) {
    return {};
  }
  const TensorRecord record = tensor_record(DataType::kFloat16, dims);
  require(count_of({record.dims, dims.rank}) == halves.size(), MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  const auto data = bytes_of(halves);
  return {record, {data.begin(), data.end()}};
}

LayerIndex NetworkWriter::dense(Layer layer, const Array& weight, const ReductionOrder& order,
                                const std::vector<float>& bias, const LayerOptions& options) {
  const std::uint32_t outputs = std::max(dim(weight, 0), 1u);
  layer.record.channels = op_of(layer.record) == LayerOp::kLstm ? outputs / 4 : outputs;
  const bool good = status_ == MIEN_OK;
  return append(std::move(layer), good ? pack_panels(weight.values, outputs, order) : Halves(),
                bias, options);
}

LayerIndex NetworkWriter::conv2d(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                                 const LayerOptions& options) {
  const auto channels = static_cast<std::size_t>(shape_of_value(x).channels);
  Layer layer = begin(LayerOp::kConv2d, x, options);
  set_window(&layer.record, dim(weight, 2), dim(weight, 3), options);
  require(has_shape(weight, {dim(weight, 0), channels, dim(weight, 2), dim(weight, 3)}),
          MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  const std::size_t taps = std::size_t{dim(weight, 2)} * dim(weight, 3);
  return dense(std::move(layer), weight, conv2d_order(channels, taps), bias, options);
}

LayerIndex NetworkWriter::depthwise(LayerIndex x, const Array& weight,
                                    const std::vector<float>& bias, const LayerOptions& options) {
  const auto channels = static_cast<std::size_t>(shape_of_value(x).channels);
  Layer layer = begin(LayerOp::kDepthwise, x, options);
  set_window(&layer.record, dim(weight, 2), dim(weight, 3), options);
  const bool good = require(has_shape(weight, {channels, 1, dim(weight, 2), dim(weight, 3)}),
                            MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  const std::size_t taps = std::size_t{dim(weight, 2)} * dim(weight, 3);
  return append(std::move(layer), good ? pack_depthwise(weight.values, channels, taps) : Halves(),
                bias, options);
}

LayerIndex NetworkWriter::pointwise(LayerIndex x, const Array& weight,
                                    const std::vector<float>& bias, const LayerOptions& options) {
  const auto channels = static_cast<std::size_t>(shape_of_value(x).channels);
  require(has_shape(weight, {dim(weight, 0), channels}), MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  return dense(begin(LayerOp::kPointwise, x, options), weight, map_order(channels, 1), bias,
               options);
}

LayerIndex NetworkWriter::fully_connected(LayerIndex x, const Array& weight,
                                          const std::vector<float>& bias,
                                          const LayerOptions& options) {
  const ValueShape map = shape_of_value(x);
  require(has_shape(weight, {dim(weight, 0), map.channels * map.height * map.width}),
          MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  const auto channels = static_cast<std::size_t>(map.channels);
  const auto pixels = static_cast<std::size_t>(map.height * map.width);
  return dense(begin(LayerOp::kFullyConnected, x, options), weight, map_order(channels, pixels),
               bias, options);
}

LayerIndex NetworkWriter::causal_conv(LayerIndex x, const Array& weight,
                                      const std::vector<float>& bias, const LayerOptions& options) {
  const auto inputs = static_cast<std::size_t>(shape_of_value(x).channels);
  require(has_shape(weight, {dim(weight, 0), inputs, 2}), MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  return dense(begin(LayerOp::kCausalConv, x, options), weight, causal_conv_order(inputs), bias,
               options);
}

LayerIndex NetworkWriter::lstm(LayerIndex x, const Array& weight_ih, const Array& weight_hh,
                               const std::vector<float>& bias, const LayerOptions& options) {
  const auto inputs = static_cast<std::size_t>(shape_of_value(x).channels);
  const std::size_t hidden = dim(weight_hh, 1);
  const bool good = require(
      has_shape(weight_ih, {4 * hidden, inputs}) && has_shape(weight_hh, {4 * hidden, hidden}),
      MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  Array rows{{static_cast<std::uint32_t>(4 * hidden)}, {}};
  for (std::size_t row = 0; good && row < 4 * hidden; ++row) {
    const auto append_row = [&](const Array& array, std::size_t count) {
      const float* first = array.values.data() + row * count;
      rows.values.insert(rows.values.end(), first, first + count);
    };
    append_row(weight_ih, inputs);
    append_row(weight_hh, hidden);
  }
  return dense(begin(LayerOp::kLstm, x, options), rows, lstm_order(inputs, hidden), bias, options);
}

LayerIndex NetworkWriter::max_pool(LayerIndex x, std::uint32_t kernel_h, std::uint32_t kernel_w,
                                   const LayerOptions& options) {
  Layer layer = begin(LayerOp::kMaxPool, x, options);
  set_window(&layer.record, kernel_h, kernel_w, options);
  layer.record.flags = options.ceil_mode ? kCeilMode : 0;
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::of_two(LayerOp op, LayerIndex a, LayerIndex b,
                                 const LayerOptions& options) {
  Layer layer = begin(op, a, options);
  layer.record.second_input = b;
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::add(LayerIndex a, LayerIndex b, const LayerOptions& options) {
  return of_two(LayerOp::kAdd, a, b, options);
}

LayerIndex NetworkWriter::multiply(LayerIndex a, LayerIndex b, const LayerOptions& options) {
  return of_two(LayerOp::kMultiply, a, b, options);
}

LayerIndex NetworkWriter::divide(LayerIndex a, LayerIndex b, const LayerOptions& options) {
  return of_two(LayerOp::kDivide, a, b, options);
}

LayerIndex NetworkWriter::broadcast_add(LayerIndex a, LayerIndex b, const LayerOptions& options) {
  return of_two(LayerOp::kBroadcastAdd, a, b, options);
}

LayerIndex NetworkWriter::resize(LayerIndex x, std::uint32_t height, std::uint32_t width,
                                 ResizeGrid grid, ResizeSampling sampling,
                                 const LayerOptions& options) {
  Layer layer = begin(LayerOp::kResize, x, options);
  const ValueShape input = shape_of_value(x);
  layer.record.height = height;
  layer.record.width = width;
  layer.record.stride_height = resize_factor(input.height, height);
  layer.record.stride_width = resize_factor(input.width, width);
  layer.record.flags = resize_flags(grid, sampling);
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::rearrange(LayerIndex x, ReadingOrder order, InputShape shape,
                                    const LayerOptions& options) {
  Layer layer = begin(LayerOp::kRearrange, x, options);
  layer.record.height = shape.height;
  layer.record.width = shape.width;
  layer.record.channels = shape.channels;
  layer.record.flags = static_cast<std::uint16_t>(order);
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::normalize(LayerIndex x, const LayerOptions& options) {
  return append(begin(LayerOp::kNormalize, x, options), {}, {}, options);
}

LayerIndex NetworkWriter::global_average_pool(LayerIndex x, const LayerOptions& options) {
  return append(begin(LayerOp::kGlobalAveragePool, x, options), {}, {}, options);
}

LayerIndex NetworkWriter::concat(LayerIndex a, LayerIndex b, const LayerOptions& options) {
  Layer layer = begin(LayerOp::kConcat, a, options);
  layer.record.second_input = b;
  const std::uint64_t channels = shape_of_value(a).channels + shape_of_value(b).channels;
  layer.record.channels = static_cast<std::uint32_t>(channels);
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::slice(LayerIndex x, std::uint16_t first_channel, std::uint32_t channels,
                                const LayerOptions& options) {
  Layer layer = begin(LayerOp::kSlice, x, options);
  layer.record.channels = channels;
  layer.record.first_channel = first_channel;
  set_margins(&layer.record, options.padding);
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::activation(LayerIndex x, const LayerOptions& options) {
  return append(begin(LayerOp::kActivation, x, options), {}, {}, options);
}

LayerIndex NetworkWriter::softmax(LayerIndex x, const LayerOptions& options) {
  return append(begin(LayerOp::kSoftmax, x, options), {}, {}, options);
}

void NetworkWriter::output(LayerIndex x) {
  const bool is_new = std::find(outputs_.begin(), outputs_.end(), x) == outputs_.end();
  if (require(x >= 1 && x <= layers_.size() && outputs_.size() < kMaxOutputs && is_new,
              MIEN_ERROR_WEIGHTS_LAYER_INPUT)) {
    outputs_.push_back(x);
  }
}

bool NetworkWriter::uses(LayerIndex value) const {
  return std::find(outputs_.begin(), outputs_.end(), value) != outputs_.end() ||
         std::any_of(layers_.begin(), layers_.end(), [&](const Layer& layer) {
           return layer.record.input == value || layer.record.second_input == value;
         });
}

mien_status NetworkWriter::status() const {
  if (status_ != MIEN_OK) {
    return status_;
  }
  for (LayerIndex value = 1; value <= layers_.size(); ++value) {
    if (!uses(value)) {
      return MIEN_ERROR_WEIGHTS_LAYER_INPUT;
    }
  }
  return MIEN_OK;
}

}  // namespace mien::formats
