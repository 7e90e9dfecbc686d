// Rules, shapes and tensors per layer operation.
#include "formats/mien_layers.h"

#include <algorithm>
#include <bit>

namespace mien::formats {
namespace {

LayerActivation activation_of(const LayerRecord& layer) {
  return static_cast<LayerActivation>(layer.activation);
}

bool is_windowed(LayerOp op) {
  return op == LayerOp::kConv2d || op == LayerOp::kDepthwise || op == LayerOp::kMaxPool;
}

// Ops whose input is a vector, which therefore need a declared size.
bool takes_vector(LayerOp op) { return op == LayerOp::kCausalConv || op == LayerOp::kLstm; }

bool has_fixed_input(LayerOp op) { return takes_vector(op) || op == LayerOp::kFullyConnected; }

// Whether the layer requires the declared input size.
bool has_fixed_size(const LayerRecord& layer) {
  const bool resizes_to =
      op_of(layer) == LayerOp::kResize && (layer.stride_height == 0 || layer.stride_width == 0);
  return has_fixed_input(op_of(layer)) || op_of(layer) == LayerOp::kRearrange || resizes_to;
}

bool chooses_channels(LayerOp op) {
  return has_fixed_input(op) || op == LayerOp::kConv2d || op == LayerOp::kPointwise;
}

// Other ops have their own nonlinearity, or only select, add or move values.
bool may_activate(LayerOp op) {
  return chooses_channels(op) ? op != LayerOp::kLstm
                              : op == LayerOp::kDepthwise || op == LayerOp::kActivation;
}

mien_status check_activation(const LayerRecord& layer, std::uint16_t minor_version) {
  const bool known = layer.activation <= static_cast<std::uint16_t>(LayerActivation::kSqrt) &&
                     version_needed(activation_of(layer)) <= minor_version;
  const bool none = activation_of(layer) == LayerActivation::kNone;
  const bool alone = activation_of(layer) >= LayerActivation::kHardSwish;
  const bool is_activation = op_of(layer) == LayerOp::kActivation;
  const bool admitted = none ? !is_activation : alone ? is_activation : may_activate(op_of(layer));
  if (!known || !admitted) {
    return MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION;
  }
  const bool has_alpha =
      activation_of(layer) == LayerActivation::kLeakyRelu || op_of(layer) == LayerOp::kNormalize;
  // Compared as bits, which are ordered like the values from +0 on, with NaNs and negative values
  // above: a comparison of floats would depend on the caller's treatment of denormal numbers.
  const auto alpha = std::bit_cast<std::uint32_t>(layer.alpha);
  const bool below_one = alpha < std::bit_cast<std::uint32_t>(1.0f);
  const bool admitted_alpha = has_alpha ? alpha > 0 && below_one : alpha == 0;
  return admitted_alpha ? MIEN_OK : MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION;
}

// Padding must be smaller than the kernel, so that no window contains only padding.
bool window_allowed(std::uint16_t kernel, std::uint16_t stride, std::uint16_t before,
                    std::uint16_t after) {
  return kernel >= 1 && kernel <= kMaxKernel && stride >= 1 && stride <= kMaxStride &&
         before < kernel && after < kernel;
}

bool no_window(const LayerRecord& layer) {
  return (layer.kernel_height | layer.kernel_width | layer.stride_height | layer.stride_width) == 0;
}

bool no_margins(const LayerRecord& layer) {
  return (layer.pad_top | layer.pad_left | layer.pad_bottom | layer.pad_right) == 0;
}

bool flags_allowed(const LayerRecord& layer) {
  switch (op_of(layer)) {
    case LayerOp::kMaxPool:
      return layer.flags <= kCeilMode;
    case LayerOp::kResize:
      return layer.flags % kResizeGrids <= static_cast<std::uint16_t>(ResizeGrid::kAlignCorners) &&
             layer.flags / kResizeGrids <= static_cast<std::uint16_t>(ResizeSampling::kBilinear);
    case LayerOp::kRearrange:
      return layer.flags <= static_cast<std::uint16_t>(ReadingOrder::kChannelColumnRow);
    default:
      return layer.flags == 0;
  }
}

bool geometry_allowed(const LayerRecord& layer) {
  if (!flags_allowed(layer)) {
    return false;
  }
  if (op_of(layer) == LayerOp::kResize) {
    return (layer.kernel_height | layer.kernel_width) == 0 && no_margins(layer);
  }
  if (!is_windowed(op_of(layer))) {
    return no_window(layer) && (op_of(layer) == LayerOp::kSlice || no_margins(layer));
  }
  return window_allowed(layer.kernel_height, layer.stride_height, layer.pad_top,
                        layer.pad_bottom) &&
         window_allowed(layer.kernel_width, layer.stride_width, layer.pad_left, layer.pad_right);
}

// Number of windows of `kernel` elements every `stride` on `before + size + after`; 0 if none fits,
// or if the window that ceil mode adds would begin after the map.
std::uint64_t window_count(std::uint64_t size, std::uint64_t kernel, std::uint64_t stride,
                           std::uint64_t before, std::uint64_t after, bool ceil_mode) {
  const std::uint64_t padded = before + size + after;
  if (padded < kernel) {
    return 0;
  }
  const std::uint64_t last = (padded - kernel + (ceil_mode ? stride - 1 : 0)) / stride;
  return last * stride < before + size ? last + 1 : 0;
}

ValueShape windowed_shape(const LayerRecord& layer, ValueShape input) {
  const bool ceil_mode = layer.flags == kCeilMode;
  return {window_count(input.height, layer.kernel_height, layer.stride_height, layer.pad_top,
                       layer.pad_bottom, ceil_mode),
          window_count(input.width, layer.kernel_width, layer.stride_width, layer.pad_left,
                       layer.pad_right, ceil_mode),
          op_of(layer) == LayerOp::kConv2d ? layer.channels : input.channels};
}

// `size` without its margins; 0 if nothing remains.
std::uint64_t cut(std::uint64_t size, std::uint64_t before, std::uint64_t after) {
  return size > before + after ? size - before - after : 0;
}

ValueShape sliced_shape(const LayerRecord& layer, ValueShape input) {
  if (std::uint64_t{layer.first_channel} + layer.channels > input.channels) {
    return {};
  }
  return {cut(input.height, layer.pad_top, layer.pad_bottom),
          cut(input.width, layer.pad_left, layer.pad_right), layer.channels};
}

ValueShape concatenated_shape(ValueShape a, ValueShape b) {
  const bool same_size = a.height == b.height && a.width == b.width;
  return same_size ? ValueShape{a.height, a.width, a.channels + b.channels} : ValueShape{};
}

bool broadcasts(LayerOp op) {
  return op == LayerOp::kMultiply || op == LayerOp::kDivide || op == LayerOp::kBroadcastAdd;
}

bool is_broadcast(std::uint64_t from, std::uint64_t to) { return from == to || from == 1; }

bool is_broadcast(ValueShape b, ValueShape a) {
  return is_broadcast(b.height, a.height) && is_broadcast(b.width, a.width) &&
         is_broadcast(b.channels, a.channels);
}

// A factor of 0 selects the declared size.
std::uint64_t resized(std::uint64_t size, std::uint16_t factor, std::uint32_t declared) {
  return factor == 0 ? declared : size * factor;
}

ValueShape resized_shape(const LayerRecord& layer, ValueShape input) {
  return {resized(input.height, layer.stride_height, layer.height),
          resized(input.width, layer.stride_width, layer.width), input.channels};
}

bool resize_factors_match(const LayerRecord& layer, ValueShape input) {
  return layer.stride_height == resize_factor(input.height, layer.height) &&
         layer.stride_width == resize_factor(input.width, layer.width);
}

ValueShape rearranged_shape(const LayerRecord& layer, ValueShape input) {
  const ValueShape output = shape_of(layer);
  return shape_allowed(output) && output.height * output.width * output.channels ==
                                      input.height * input.width * input.channels
             ? output
             : ValueShape{};
}

// Whether b is at least as large as a, by an even number of rows and columns.
bool has_centre_slice(ValueShape a, ValueShape b) {
  return a.channels == b.channels && b.height >= a.height && b.width >= a.width &&
         (b.height - a.height) % 2 == 0 && (b.width - a.width) % 2 == 0;
}

constexpr std::uint64_t kPanel = 16;
constexpr std::uint64_t kBlock = 8;
constexpr std::size_t kElementBytes = 2;

// Searches runs of elements of a tensor for one that is not zero.
class Search {
 public:
  explicit Search(std::span<const std::byte> tensor) : tensor_(tensor), found_(tensor.size()) {}

  [[nodiscard]] bool done() const { return found_ < tensor_.size(); }
  [[nodiscard]] std::size_t found() const { return found_; }

  void run(std::uint64_t first, std::uint64_t count) {
    const auto end = static_cast<std::size_t>((first + count) * kElementBytes);
    for (auto at = static_cast<std::size_t>(first * kElementBytes); at < end && !done(); ++at) {
      found_ = tensor_[at] != std::byte{0} ? at / kElementBytes * kElementBytes : found_;
    }
  }

 private:
  std::span<const std::byte> tensor_;
  std::size_t found_;
};

// A panel: index of its first element, number of outputs, number of used outputs.
struct Panel {
  std::uint64_t first, width, used;
};

// Only the last block of a map has unused channels, at each of its pixels.
void search_inputs(const TensorLanes& lanes, const Panel& panel, Search& search) {
  const std::uint64_t used = lanes.map_channels % kBlock;
  if (used == 0) {
    return;
  }
  const std::uint64_t channels = padded8(lanes.map_channels);
  for (std::uint64_t map = 0; map < lanes.maps; ++map) {
    std::uint64_t step = (map * channels + channels - kBlock) * lanes.pixels;
    for (std::uint64_t pixel = 0; pixel < lanes.pixels; ++pixel, step += kBlock) {
      search.run(panel.first + (step + used) * panel.width, (kBlock - used) * panel.width);
    }
  }
}

void search_outputs(const TensorLanes& lanes, const Panel& panel, Search& search) {
  for (std::uint64_t step = 0; panel.used < panel.width && step < lanes.steps; ++step) {
    search.run(panel.first + step * panel.width + panel.used, panel.width - panel.used);
  }
}

LayerTensor vector_of(std::uint64_t outputs) {
  return {{1, {padded8(outputs)}}, {outputs, kBlock, 1, 0, 0, 0}};
}

LayerTensor weights_of(const LayerRecord& layer, ValueShape input) {
  const std::uint64_t outputs = layer.channels, channels = input.channels;
  const std::uint64_t out = padded8(outputs), blocked = padded8(channels);
  const std::uint64_t pixels = input.height * input.width;
  const std::uint64_t height = layer.kernel_height, width = layer.kernel_width;
  switch (op_of(layer)) {
    case LayerOp::kConv2d:
      return {{4, {out, height, width, channels}},
              {outputs, kPanel, height * width * channels, 0, 0, 0}};
    case LayerOp::kDepthwise:
      return {{3, {out, height, width}}, {outputs, kBlock, height * width, 0, 0, 0}};
    case LayerOp::kPointwise:
      return {{2, {out, blocked}}, {outputs, kPanel, blocked, 1, 1, channels}};
    case LayerOp::kFullyConnected:
      return {{2, {out, blocked * pixels}},
              {outputs, kPanel, blocked * pixels, 1, pixels, channels}};
    case LayerOp::kCausalConv:
      return {{3, {out, 2, blocked}}, {outputs, kPanel, 2 * blocked, 2, 1, channels}};
    case LayerOp::kLstm:  // its own output has no unused lane
      return {{2, {4 * out, blocked + out}},
              {4 * outputs, kPanel, blocked + outputs, 1, 1, channels}};
    case LayerOp::kMaxPool:
    case LayerOp::kAdd:
    case LayerOp::kActivation:
    case LayerOp::kSoftmax:
    case LayerOp::kGlobalAveragePool:
    case LayerOp::kConcat:
    case LayerOp::kSlice:
    case LayerOp::kMultiply:
    case LayerOp::kDivide:
    case LayerOp::kBroadcastAdd:
    case LayerOp::kResize:
    case LayerOp::kRearrange:
    case LayerOp::kNormalize:
      break;
  }
  return {};
}

}  // namespace

mien_status check_outputs(const NetworkRecord& network, std::uint16_t minor_version,
                          std::uint32_t& place) {
  const std::uint32_t count = network.output_count;
  place = kNoIndex;
  if (count == 0 || count > kMaxOutputs || version_needed(network) > minor_version) {
    return MIEN_ERROR_WEIGHTS_NETWORK;
  }
  const std::uint32_t width = output_place(count, 1);  // elements per output
  for (place = 0; place < kMaxOutputs; ++place) {
    const std::uint32_t value = network.outputs[place];
    const bool used = place % width == 0 && place / width < count;
    if (used ? value == 0 || value > network.layer_count : value != 0) {
      const bool reserved = count <= kMaxWideOutputs && place >= 2 * kMaxWideOutputs;
      place = reserved ? 2 * kMaxWideOutputs : place;
      return reserved ? MIEN_ERROR_WEIGHTS_RESERVED : MIEN_ERROR_WEIGHTS_NETWORK;
    }
  }
  return MIEN_OK;
}

bool shape_allowed(ValueShape shape) {
  for (const std::uint64_t dim : {shape.height, shape.width, shape.channels}) {
    if (dim == 0 || dim > kMaxDim) {
      return false;
    }
  }
  return shape.height * shape.width <= kMaxMapElems / padded8(shape.channels);
}

// Compared as bits, as in check_activation.
bool input_bound_allowed(const LayerRecord& layer) {
  const auto bound = std::bit_cast<std::uint32_t>(layer.input_bound);
  return bound >= std::bit_cast<std::uint32_t>(kMinInputBound) &&
         bound <= std::bit_cast<std::uint32_t>(kMaxInputBound);
}

mien_status check_layer(const LayerRecord& layer, std::uint32_t value, std::uint32_t network_flags,
                        std::uint16_t minor_version) {
  if (layer.op < static_cast<std::uint16_t>(LayerOp::kConv2d) ||
      layer.op > static_cast<std::uint16_t>(LayerOp::kNormalize) ||
      version_needed(op_of(layer)) > minor_version) {
    return MIEN_ERROR_WEIGHTS_LAYER_OP;
  }
  if (network_flags == kAnySize && has_fixed_size(layer)) {
    return MIEN_ERROR_WEIGHTS_LAYER_OP;
  }
  const bool slices = op_of(layer) == LayerOp::kSlice;
  const bool has_bound = std::bit_cast<std::uint32_t>(layer.input_bound) != 0;
  const bool may_bound = op_of(layer) == LayerOp::kPointwise && minor_version >= 3;
  if ((layer.first_channel != 0 && !slices) || (has_bound && !may_bound)) {
    return MIEN_ERROR_WEIGHTS_RESERVED;
  }
  if (has_bound && !input_bound_allowed(layer)) {
    return MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION;
  }
  const bool two = takes_two(op_of(layer));
  if (layer.input >= value ||
      (two ? layer.second_input >= value : layer.second_input != kNoIndex)) {
    return MIEN_ERROR_WEIGHTS_LAYER_INPUT;
  }
  if (!geometry_allowed(layer)) {
    return MIEN_ERROR_WEIGHTS_LAYER_WINDOW;
  }
  return check_activation(layer, minor_version);
}

ValueShape output_shape(const LayerRecord& layer, ValueShape input, ValueShape second) {
  const LayerOp op = op_of(layer);
  const bool invalid = (takes_vector(op) && (input.height != 1 || input.width != 1)) ||
                       (op == LayerOp::kLstm && layer.channels % 8 != 0) ||
                       (op == LayerOp::kAdd && !has_centre_slice(input, second)) ||
                       (broadcasts(op) && !is_broadcast(second, input));
  if (invalid) {
    return {};
  }
  if (is_windowed(op)) {
    return windowed_shape(layer, input);
  }
  switch (op) {
    case LayerOp::kFullyConnected:
      return {1, 1, layer.channels};
    case LayerOp::kGlobalAveragePool:
      return {1, 1, input.channels};
    case LayerOp::kConcat:
      return concatenated_shape(input, second);
    case LayerOp::kSlice:
      return sliced_shape(layer, input);
    case LayerOp::kResize:
      return resized_shape(layer, input);
    case LayerOp::kRearrange:
      return rearranged_shape(layer, input);
    default:
      break;
  }
  return {input.height, input.width, chooses_channels(op) ? layer.channels : input.channels};
}

ValueShape declared_output_shape(const LayerRecord& layer, ValueShape input, ValueShape second) {
  const bool invalid = op_of(layer) == LayerOp::kResize && !resize_factors_match(layer, input);
  return invalid ? ValueShape{} : output_shape(layer, input, second);
}

LayerTensors tensors_of(const LayerRecord& layer, ValueShape input) {
  LayerTensors tensors;
  tensors.weights = weights_of(layer, input);
  const std::uint64_t outputs = layer.channels;
  if (tensors.weights.dims.rank != 0) {
    tensors.bias = vector_of(op_of(layer) == LayerOp::kLstm ? 4 * outputs : outputs);
  }
  if (activation_of(layer) == LayerActivation::kPrelu) {
    tensors.slopes = vector_of(outputs);
  }
  return tensors;
}

std::size_t find_filled(const TensorLanes& lanes, std::span<const std::byte> tensor) {
  Search search(tensor);
  const std::uint64_t padded = padded8(lanes.outputs);
  for (std::uint64_t output = 0; output < padded && !search.done(); output += lanes.panel) {
    const std::uint64_t width = std::min(lanes.panel, padded - output);
    const Panel panel{output * lanes.steps, width, std::min(width, lanes.outputs - output)};
    search_inputs(lanes, panel, search);
    search_outputs(lanes, panel, search);
  }
  return search.found();
}

}  // namespace mien::formats
