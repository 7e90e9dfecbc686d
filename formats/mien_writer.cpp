#include "formats/mien_writer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "formats/checked.h"
#include "formats/fp16.h"
#include "formats/xxhash64.h"

namespace mien::formats {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

void append_bytes(std::vector<std::byte>* file, std::span<const std::byte> bytes) {
  file->insert(file->end(), bytes.begin(), bytes.end());
}

void align(std::vector<std::byte>* file) {
  file->resize((file->size() + kFileAlignment - 1) / kFileAlignment * kFileAlignment);
}

std::uint64_t count_of(std::span<const std::uint32_t> shape) {
  std::uint64_t count = 1;
  for (const std::uint32_t dim : shape) {
    count *= dim;
  }
  return count;
}

// Whether the array is [dims..., 1, 1, ...] and not empty.
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

TensorRecord tensor_record(DataType type, const TensorDims& dims) {
  TensorRecord record{};
  record.type = static_cast<std::uint16_t>(type);
  record.rank = static_cast<std::uint16_t>(dims.rank);
  std::transform(dims.dim, dims.dim + kMaxRank, record.dims,
                 [](std::uint64_t n) { return static_cast<std::uint32_t>(n); });
  return record;
}

void set_margins(LayerRecord* record, const Padding& padding) {
  record->pad_top = padding.top;
  record->pad_left = padding.left;
  record->pad_bottom = padding.bottom;
  record->pad_right = padding.right;
}

// The reader wants the file aligned, which a vector of bytes is not.
Validation validated(std::span<const std::byte> file) {
  struct alignas(kFileAlignment) Line {
    std::byte bytes[kFileAlignment];
  };
  std::vector<Line> copy(file.size() / sizeof(Line));
  std::memcpy(copy.data(), file.data(), file.size());
  FileView view;
  return open(std::as_bytes(std::span(copy)), view);
}

}  // namespace

NetworkWriter::NetworkWriter(std::string name, InputShape input, bool any_size)
    : name_(std::move(name)) {
  record_.input_height = input.height;
  record_.input_width = input.width;
  record_.input_channels = input.channels;
  record_.flags = any_size ? kAnySize : 0;
  require(shape_allowed(shape_of_value(0)), FileStatus::kBadNetwork);
}

bool NetworkWriter::require(bool condition, FileStatus status) {
  if (!condition && status_ == FileStatus::kOk) {
    status_ = status;
  }
  return condition;
}

ValueShape NetworkWriter::shape_of_value(LayerIndex value) {
  if (value == 0) {
    return {record_.input_height, record_.input_width, record_.input_channels};
  }
  return require(value <= layers_.size(), FileStatus::kBadReference)
             ? shape_of(layers_[value - 1].record)
             : ValueShape{};
}

NetworkWriter::Layer NetworkWriter::begin(LayerOp op, LayerIndex x, const LayerOptions& options) {
  Layer layer{};
  layer.record.op = static_cast<std::uint16_t>(op);
  layer.record.activation = static_cast<std::uint16_t>(options.activation);
  layer.record.alpha = options.alpha;
  layer.record.input = x;
  layer.record.second_input = kNoIndex;
  layer.record.weights = layer.record.bias = layer.record.slopes = kNoIndex;
  layer.record.channels = static_cast<std::uint32_t>(shape_of_value(x).channels);
  return layer;
}

void NetworkWriter::slide(LayerRecord* record, std::uint32_t kernel_h, std::uint32_t kernel_w,
                          const LayerOptions& options) {
  // Too large a kernel must not become a small one.
  record->kernel_height = static_cast<std::uint16_t>(std::min(kernel_h, 0xffffu));
  record->kernel_width = static_cast<std::uint16_t>(std::min(kernel_w, 0xffffu));
  record->stride_height = options.stride_y;
  record->stride_width = options.stride_x;
  set_margins(record, options.padding);
}

// Checks what the format says about the layer and gives it its shape.
bool NetworkWriter::place(LayerRecord* record) {
  const auto value = static_cast<std::uint32_t>(layers_.size() + 1);
  const FileStatus status = check_layer(*record, value, record_.flags, kMinorVersion);
  if (!require(status == FileStatus::kOk, status)) {
    return false;
  }
  const ValueShape input = shape_of_value(record->input);
  const bool two = takes_two(op_of(*record));
  const ValueShape output =
      output_shape(*record, input, two ? shape_of_value(record->second_input) : input);
  record->height = static_cast<std::uint32_t>(output.height);
  record->width = static_cast<std::uint32_t>(output.width);
  return require(shape_allowed(output), FileStatus::kBadShape) && status_ == FileStatus::kOk;
}

// A layer at fault is kept, so that the values behind it keep their numbers; finish() reports it.
LayerIndex NetworkWriter::append(Layer layer, const Halves& weights, std::vector<float> bias,
                                 const LayerOptions& options) {
  if (place(&layer.record)) {
    const LayerTensors tensors = tensors_of(layer.record, shape_of_value(layer.record.input));
    const bool gates = op_of(layer.record) == LayerOp::kLstm;
    const std::size_t outputs = layer.record.channels * (gates ? std::size_t{4} : std::size_t{1});
    bias.resize(bias.empty() ? outputs : bias.size());
    require(bias.size() == outputs, FileStatus::kBadTensor);
    require(options.slopes.size() == (tensors.slopes.dims.rank == 0 ? 0 : layer.record.channels),
            FileStatus::kBadTensor);
    layer.weights = tensor(tensors.weights.dims, weights);
    layer.bias = tensor(tensors.bias.dims, pack_vector(bias));
    layer.slopes = tensor(tensors.slopes.dims, pack_vector(options.slopes));
  }
  layers_.push_back(std::move(layer));
  return static_cast<LayerIndex>(layers_.size());
}

// `dims` of rank 0 is no tensor.
NetworkWriter::Tensor NetworkWriter::tensor(const TensorDims& dims, const Halves& halves) {
  if (dims.rank == 0) {
    return {};
  }
  const TensorRecord record = tensor_record(DataType::kFloat16, dims);
  require(count_of({record.dims, dims.rank}) == halves.size(), FileStatus::kBadTensor);
  const auto data = bytes_of(halves);
  return {record, {data.begin(), data.end()}};
}

LayerIndex NetworkWriter::dense(Layer layer, const Array& weight, const ReductionOrder& order,
                                const std::vector<float>& bias, const LayerOptions& options) {
  const std::uint32_t outputs = std::max(dim(weight, 0), 1u);
  layer.record.channels = op_of(layer.record) == LayerOp::kLstm ? outputs / 4 : outputs;
  const bool good = status_ == FileStatus::kOk;
  return append(std::move(layer), good ? pack_panels(weight.values, outputs, order) : Halves(),
                bias, options);
}

LayerIndex NetworkWriter::conv2d(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                                 const LayerOptions& options) {
  const auto channels = static_cast<std::size_t>(shape_of_value(x).channels);
  Layer layer = begin(LayerOp::kConv2d, x, options);
  slide(&layer.record, dim(weight, 2), dim(weight, 3), options);
  require(has_shape(weight, {dim(weight, 0), channels, dim(weight, 2), dim(weight, 3)}),
          FileStatus::kBadTensor);
  const std::size_t taps = std::size_t{dim(weight, 2)} * dim(weight, 3);
  return dense(std::move(layer), weight, conv2d_order(channels, taps), bias, options);
}

LayerIndex NetworkWriter::depthwise(LayerIndex x, const Array& weight,
                                    const std::vector<float>& bias, const LayerOptions& options) {
  const auto channels = static_cast<std::size_t>(shape_of_value(x).channels);
  Layer layer = begin(LayerOp::kDepthwise, x, options);
  slide(&layer.record, dim(weight, 2), dim(weight, 3), options);
  const bool good = require(has_shape(weight, {channels, 1, dim(weight, 2), dim(weight, 3)}),
                            FileStatus::kBadTensor);
  const std::size_t taps = std::size_t{dim(weight, 2)} * dim(weight, 3);
  return append(std::move(layer), good ? pack_depthwise(weight.values, channels, taps) : Halves(),
                bias, options);
}

LayerIndex NetworkWriter::pointwise(LayerIndex x, const Array& weight,
                                    const std::vector<float>& bias, const LayerOptions& options) {
  const auto channels = static_cast<std::size_t>(shape_of_value(x).channels);
  require(has_shape(weight, {dim(weight, 0), channels}), FileStatus::kBadTensor);
  return dense(begin(LayerOp::kPointwise, x, options), weight, map_order(channels, 1), bias,
               options);
}

LayerIndex NetworkWriter::fully_connected(LayerIndex x, const Array& weight,
                                          const std::vector<float>& bias,
                                          const LayerOptions& options) {
  const ValueShape map = shape_of_value(x);
  require(has_shape(weight, {dim(weight, 0), map.channels * map.height * map.width}),
          FileStatus::kBadTensor);
  const auto channels = static_cast<std::size_t>(map.channels);
  const auto pixels = static_cast<std::size_t>(map.height * map.width);
  return dense(begin(LayerOp::kFullyConnected, x, options), weight, map_order(channels, pixels),
               bias, options);
}

LayerIndex NetworkWriter::causal_conv(LayerIndex x, const Array& weight,
                                      const std::vector<float>& bias, const LayerOptions& options) {
  const auto inputs = static_cast<std::size_t>(shape_of_value(x).channels);
  require(has_shape(weight, {dim(weight, 0), inputs, 2}), FileStatus::kBadTensor);
  return dense(begin(LayerOp::kCausalConv, x, options), weight, causal_conv_order(inputs), bias,
               options);
}

LayerIndex NetworkWriter::lstm(LayerIndex x, const Array& weight_ih, const Array& weight_hh,
                               const std::vector<float>& bias, const LayerOptions& options) {
  const auto inputs = static_cast<std::size_t>(shape_of_value(x).channels);
  const std::size_t hidden = dim(weight_hh, 1);
  const bool good = require(
      has_shape(weight_ih, {4 * hidden, inputs}) && has_shape(weight_hh, {4 * hidden, hidden}),
      FileStatus::kBadTensor);
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
  slide(&layer.record, kernel_h, kernel_w, options);
  layer.record.flags = options.ceil_mode ? kCeilMode : 0;
  return append(std::move(layer), {}, {}, options);
}

LayerIndex NetworkWriter::add(LayerIndex a, LayerIndex b, const LayerOptions& options) {
  Layer layer = begin(LayerOp::kAdd, a, options);
  layer.record.second_input = b;
  return append(std::move(layer), {}, {}, options);
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
  const auto* last = record_.outputs + record_.output_count;
  if (require(x >= 1 && x <= layers_.size() && record_.output_count < kMaxOutputs &&
                  std::find(static_cast<const std::uint32_t*>(record_.outputs), last, x) == last,
              FileStatus::kBadReference)) {
    record_.outputs[record_.output_count++] = x;
  }
}

bool NetworkWriter::uses(LayerIndex value) const {
  const auto* last = record_.outputs + record_.output_count;
  return std::find(static_cast<const std::uint32_t*>(record_.outputs), last, value) != last ||
         std::any_of(layers_.begin(), layers_.end(), [&](const Layer& layer) {
           return layer.record.input == value || layer.record.second_input == value;
         });
}

FileStatus NetworkWriter::status() const {
  if (status_ != FileStatus::kOk) {
    return status_;
  }
  for (LayerIndex value = 1; value <= layers_.size(); ++value) {
    if (!uses(value)) {
      return FileStatus::kBadReference;
    }
  }
  return FileStatus::kOk;
}

NetworkWriter& MienWriter::network(std::string name, InputShape input, bool any_size) {
  networks_.push_back(NetworkWriter(std::move(name), input, any_size));
  return networks_.back();
}

void MienWriter::constant(std::string name, const Array& array, DataType type) {
  TensorDims dims{static_cast<std::uint32_t>(array.shape.size()), {}};
  if (dims.rank == 0 || dims.rank > kMaxRank || count_of(array.shape) != array.values.size()) {
    status_ = FileStatus::kBadDims;
    return;
  }
  std::copy(array.shape.begin(), array.shape.end(), dims.dim);
  NetworkWriter::Tensor tensor{tensor_record(type, dims), {}};
  if (type == DataType::kFloat16) {
    Halves halves(array.values.size());
    std::transform(array.values.begin(), array.values.end(), halves.begin(), fp16_from_float);
    append_bytes(&tensor.data, bytes_of(halves));
  } else {
    append_bytes(&tensor.data, bytes_of(array.values));
  }
  constants_.push_back({std::move(name), std::move(tensor)});
}

void MienWriter::metadata(const std::string& key, std::string value) {
  metadata_[key] = std::move(value);
}

struct FileSections {
  std::vector<NetworkRecord> networks;
  std::vector<LayerRecord> layers;
  std::vector<TensorRecord> tensors;
  std::vector<MetadataRecord> metadata;
  std::string strings;
  std::vector<std::byte> data;  // of the tensors, whose offsets count from its start

  StringRef add_string(const std::string& string) {
    const StringRef ref = {static_cast<std::uint32_t>(strings.size()),
                           static_cast<std::uint32_t>(string.size())};
    strings += string;
    return ref;
  }

  std::uint32_t add_tensor(TensorRecord record, const std::string& name,
                           const std::vector<std::byte>& values) {
    record.name = add_string(name);
    record.offset = data.size();
    record.bytes = values.size();
    append_bytes(&data, values);
    align(&data);
    tensors.push_back(record);
    return static_cast<std::uint32_t>(tensors.size() - 1);
  }
};

namespace {

// The smallest that the layers need.
std::uint16_t minor_version_of(const std::vector<LayerRecord>& layers) {
  std::uint16_t version = 0;
  for (const LayerRecord& layer : layers) {
    version = std::max(version, version_needed(layer));
  }
  return version;
}

FileHeader file_header(const FileSections& sections) {
  FileHeader header{};
  std::copy(std::begin(kMagic), std::end(kMagic), header.magic);
  header.major_version = kMajorVersion;
  header.minor_version = minor_version_of(sections.layers);
  header.endian_tag = kEndianTag;
  header.header_bytes = sizeof(FileHeader);
  header.network_count = static_cast<std::uint32_t>(sections.networks.size());
  header.layer_count = static_cast<std::uint32_t>(sections.layers.size());
  header.tensor_count = static_cast<std::uint32_t>(sections.tensors.size());
  header.metadata_count = static_cast<std::uint32_t>(sections.metadata.size());
  header.string_bytes = static_cast<std::uint32_t>(sections.strings.size());
  const std::uint64_t records = bytes_of(sections.networks).size() +
                                bytes_of(sections.layers).size() +
                                bytes_of(sections.tensors).size() +
                                bytes_of(sections.metadata).size() + sections.strings.size();
  header.data_offset = Checked(sizeof(FileHeader) + records).aligned(kFileAlignment).value();
  header.total_bytes = header.data_offset + sections.data.size();
  return header;
}

std::vector<std::byte> assembled(FileSections sections) {
  FileHeader header = file_header(sections);
  for (TensorRecord& tensor : sections.tensors) {
    tensor.offset += header.data_offset;
  }
  std::vector<std::byte> file;
  append_bytes(&file, std::as_bytes(std::span(&header, 1)));
  append_bytes(&file, bytes_of(sections.networks));
  append_bytes(&file, bytes_of(sections.layers));
  append_bytes(&file, bytes_of(sections.tensors));
  append_bytes(&file, bytes_of(sections.metadata));
  append_bytes(&file, std::as_bytes(std::span(sections.strings)));
  align(&file);
  append_bytes(&file, sections.data);
  header.checksum = xxhash64_with_hole(file, offsetof(FileHeader, checksum));
  std::memcpy(file.data(), &header, sizeof header);
  return file;
}

}  // namespace

// Networks and layers in order; says what is wrong with the first network at fault.
FileStatus MienWriter::add_networks(FileSections* sections) const {
  for (const NetworkWriter& network : networks_) {
    if (const FileStatus status = network.status(); status != FileStatus::kOk) {
      return status;
    }
    NetworkRecord record = network.record_;
    record.name = sections->add_string(network.name_);
    record.first_layer = static_cast<std::uint32_t>(sections->layers.size());
    record.layer_count = static_cast<std::uint32_t>(network.layers_.size());
    sections->networks.push_back(record);
    for (const NetworkWriter::Layer& layer : network.layers_) {
      sections->layers.push_back(layer.record);
    }
  }
  return status_;
}

void MienWriter::add_tensors(FileSections* sections) const {
  const auto add = [&](const NetworkWriter::Tensor& tensor) {
    return tensor.data.empty() ? kNoIndex : sections->add_tensor(tensor.record, "", tensor.data);
  };
  auto record = sections->layers.begin();
  for (const NetworkWriter& network : networks_) {
    for (const NetworkWriter::Layer& layer : network.layers_) {
      record->weights = add(layer.weights);
      record->bias = add(layer.bias);
      record->slopes = add(layer.slopes);
      ++record;
    }
  }
  for (const Constant& constant : constants_) {
    sections->add_tensor(constant.tensor.record, constant.name, constant.tensor.data);
  }
}

Validation MienWriter::finish(std::vector<std::byte>* file) const {
  file->clear();
  FileSections sections;
  if (const FileStatus status = add_networks(&sections); status != FileStatus::kOk) {
    return {status, 0};
  }
  add_tensors(&sections);
  for (const auto& [key, value] : metadata_) {
    const StringRef name = sections.add_string(key);
    sections.metadata.push_back({name, sections.add_string(value)});
  }
  std::vector<std::byte> bytes = assembled(std::move(sections));
  const Validation validation = validated(bytes);
  if (validation.status == FileStatus::kOk) {
    *file = std::move(bytes);
  }
  return validation;
}

}  // namespace mien::formats
