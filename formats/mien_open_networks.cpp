// The rules of the networks in a weight file, and of their layers.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "formats/mien_validator.h"

namespace mien::formats {

bool Validator::networks() {
  for (const NetworkRecord& record : network_records) {
    ++network_;
    layer_ = -1;
    if (!network(record)) {
      return false;
    }
  }
  network_ = layer_ = -1;
  if (next_layer_ != header().layer_count) {
    return fail_at(MIEN_ERROR_WEIGHTS_NETWORK, header().layer_count, "layer_count", next_layer_,
                   next_layer_);
  }
  if (version_needed_ != header().minor_version) {
    return fail_at(MIEN_ERROR_WEIGHTS_VERSION, header().minor_version, "minor_version",
                   version_needed_, version_needed_);
  }
  return constants();
}

bool Validator::network(const NetworkRecord& record) {
  if (!shape_allowed({record.input_height, record.input_width, record.input_channels})) {
    return fail_at(MIEN_ERROR_WEIGHTS_NETWORK, record.input_height, "input_height");
  }
  if (record.flags > kAnySize) {
    return fail_at(MIEN_ERROR_WEIGHTS_NETWORK, record.flags, "flags", 0, kAnySize);
  }
  if (record.first_layer != next_layer_) {
    return fail_at(MIEN_ERROR_WEIGHTS_NETWORK, record.first_layer, "first_layer", next_layer_,
                   next_layer_);
  }
  if (record.layer_count == 0 || record.layer_count > header().layer_count - next_layer_) {
    fail_at(MIEN_ERROR_WEIGHTS_NETWORK, record.first_layer, "layer_count");
    set_got(result_, record.layer_count);
    return expect(1, header().layer_count - next_layer_);
  }
  next_layer_ += record.layer_count;
  for (std::uint32_t i = 0; i < record.layer_count; ++i) {
    layer_ = static_cast<std::int32_t>(i);
    if (!layer(record, i)) {
      return false;
    }
  }
  layer_ = -1;
  version_needed_ = std::max(version_needed_, version_needed(record));
  return outputs(record);
}

bool Validator::outputs(const NetworkRecord& record) {
  std::uint32_t place = kNoIndex;
  const mien_status status = check_outputs(record, header().minor_version, place);
  if (status == MIEN_OK) {
    return true;
  }
  if (place == kNoIndex) {
    return fail_at(status, record.output_count, "output_count", 1, kMaxOutputs);
  }
  return fail_at(status, record.outputs[place], "outputs");
}

ValueShape Validator::value_shape(const NetworkRecord& network, std::uint32_t value) const {
  if (value == 0) {
    return {network.input_height, network.input_width, network.input_channels};
  }
  return shape_of(layer_records[network.first_layer + value - 1]);
}

bool Validator::layer(const NetworkRecord& network, std::uint32_t index) {
  const LayerRecord& record = layer_records[network.first_layer + index];
  if (!layer_fields(network, record)) {
    return false;
  }
  version_needed_ = std::max(version_needed_, version_needed(record));
  const ValueShape input = value_shape(network, record.input);
  const bool two = takes_two(op_of(record));
  const ValueShape second = two ? value_shape(network, record.second_input) : input;
  if (!layer_shape(record, declared_output_shape(record, input, second))) {
    return false;
  }
  const LayerTensors tensors = tensors_of(record, input);
  return layer_tensor(record.weights, tensors.weights, "weights") &&
         layer_tensor(record.bias, tensors.bias, "bias") &&
         layer_tensor(record.slopes, tensors.slopes, "slopes");
}

// The offset of the error is that of the layer.
bool Validator::layer_fields(const NetworkRecord& network, const LayerRecord& record) {
  const auto value = static_cast<std::uint32_t>(layer_) + 1;
  const mien_status status = check_layer(record, value, network.flags, header().minor_version);
  switch (status) {
    case MIEN_OK:
      return true;
    case MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION:
      if (std::bit_cast<std::uint32_t>(record.input_bound) != 0 && !input_bound_allowed(record)) {
        fail_at(status, record, "input_bound");
        set_got(result_, record.input_bound);
        return false;
      }
      fail_at(status, record, "activation");
      set_got(result_, record.activation);
      return false;
    case MIEN_ERROR_WEIGHTS_LAYER_INPUT:
      fail_at(status, record, record.input >= value ? "input" : "second_input");
      set_got(result_, record.input >= value ? record.input : record.second_input);
      return expect(0, value - 1);
    case MIEN_ERROR_WEIGHTS_LAYER_OP:
      fail_at(status, record, "op");
      set_got(result_, record.op);
      return false;
    default:
      return fail_at(status, record, nullptr);
  }
}

bool Validator::layer_shape(const LayerRecord& record, const ValueShape& output) {
  if (!shape_allowed(output)) {
    return fail_at(MIEN_ERROR_WEIGHTS_LAYER_SHAPE, record.height, nullptr);
  }
  const ValueShape declared = shape_of(record);
  if (output == declared) {
    return true;
  }
  const bool height = output.height != declared.height, width = output.width != declared.width;
  const std::uint64_t got = height ? declared.height : width ? declared.width : declared.channels;
  const std::uint64_t computed = height ? output.height : width ? output.width : output.channels;
  fail_at(MIEN_ERROR_WEIGHTS_LAYER_SHAPE, record.height,
          height  ? "height"
          : width ? "width"
                  : "channels");
  set_got(result_, static_cast<double>(got));
  return expect(computed, computed);
}

// Layers' tensors come first, in the order of use, so that each belongs to one layer.
bool Validator::layer_tensor(const std::uint32_t& index, const LayerTensor& tensor,
                             const char* field) {
  if (tensor.dims.rank == 0) {
    return index == kNoIndex ||
           fail_at(MIEN_ERROR_WEIGHTS_LAYER_TENSORS, index, field, kNoIndex, kNoIndex);
  }
  if (index != next_tensor_ || next_tensor_ >= header().tensor_count) {
    return fail_at(MIEN_ERROR_WEIGHTS_LAYER_TENSORS, index, field, next_tensor_, next_tensor_);
  }
  const TensorRecord& record = tensor_records[next_tensor_++];
  if (!tensor_matches(index, record, tensor.dims, field)) {
    return false;
  }
  const std::size_t filled = find_filled(tensor.lanes, part(record.offset, record.bytes));
  return filled == record.bytes || fail(MIEN_ERROR_WEIGHTS_PADDING, record.offset + filled, field);
}

bool Validator::tensor_matches(const std::uint32_t& index, const TensorRecord& record,
                               const TensorDims& dims, const char* field) {
  if (type_of(record) != DataType::kFloat16 || record.rank != dims.rank || record.name.bytes != 0) {
    return fail_at(MIEN_ERROR_WEIGHTS_LAYER_TENSORS, index, field);
  }
  for (std::uint32_t i = 0; i < kMaxRank; ++i) {
    if (record.dims[i] != dims.dim[i]) {
      fail_at(MIEN_ERROR_WEIGHTS_LAYER_TENSORS, index, field);
      set_got(result_, record.dims[i]);
      return expect(dims.dim[i], dims.dim[i]);
    }
  }
  return true;
}

bool Validator::constants() {
  for (const TensorRecord& record : tensor_records.subspan(next_tensor_)) {
    if (record.name.bytes == 0) {
      return fail_at(MIEN_ERROR_WEIGHTS_TENSOR_UNUSED, record.name, "name");
    }
  }
  return true;
}

}  // namespace mien::formats
