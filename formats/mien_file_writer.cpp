// Assembles the sections of a weight file.
#include <algorithm>
#include <cstring>
#include <utility>

#include "formats/checked.h"
#include "formats/fp16.h"
#include "formats/mien_writer.h"
#include "formats/writer_bytes.h"
#include "formats/xxhash64.h"

namespace mien::formats {
namespace {

void append_bytes(std::vector<std::byte>* file, std::span<const std::byte> bytes) {
  file->insert(file->end(), bytes.begin(), bytes.end());
}

void align(std::vector<std::byte>* file) {
  file->resize((file->size() + kFileAlignment - 1) / kFileAlignment * kFileAlignment);
}

// Copies the file to aligned memory, which the reader requires.
mien_error_detail validated(std::span<const std::byte> file) {
  struct alignas(kFileAlignment) Line {
    std::byte bytes[kFileAlignment];
  };
  std::vector<Line> copy(file.size() / sizeof(Line));
  std::memcpy(copy.data(), file.data(), file.size());
  FileView view;
  return open(std::as_bytes(std::span(copy)), view);
}

}  // namespace

NetworkWriter& MienWriter::network(std::string name, InputShape input, bool any_size) {
  networks_.push_back(NetworkWriter(std::move(name), input, any_size));
  return networks_.back();
}

void MienWriter::constant(std::string name, const Array& array, DataType type) {
  TensorDims dims{static_cast<std::uint32_t>(array.shape.size()), {}};
  if (dims.rank == 0 || dims.rank > kMaxRank || count_of(array.shape) != array.values.size()) {
    status_ = MIEN_ERROR_WEIGHTS_TENSOR_DIMS;
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
  std::vector<std::byte> data;  // data of the tensors, whose offsets count from its start

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

// The lowest minor version that the networks and layers allow.
std::uint16_t minor_version_of(const FileSections& sections) {
  std::uint16_t version = 0;
  for (const NetworkRecord& network : sections.networks) {
    version = std::max(version, version_needed(network));
  }
  for (const LayerRecord& layer : sections.layers) {
    version = std::max(version, version_needed(layer));
  }
  return version;
}

FileHeader file_header(const FileSections& sections) {
  FileHeader header{};
  std::copy(std::begin(kMagic), std::end(kMagic), header.magic);
  header.major_version = kMajorVersion;
  header.minor_version = minor_version_of(sections);
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

// Adds networks and layers in order; returns the error of the first invalid network.
mien_status MienWriter::add_networks(FileSections* sections) const {
  for (const NetworkWriter& network : networks_) {
    if (const mien_status status = network.status(); status != MIEN_OK) {
      return status;
    }
    NetworkRecord record = network.record_;
    record.name = sections->add_string(network.name_);
    record.first_layer = static_cast<std::uint32_t>(sections->layers.size());
    record.layer_count = static_cast<std::uint32_t>(network.layers_.size());
    record.output_count = static_cast<std::uint32_t>(network.outputs_.size());
    for (std::uint32_t i = 0; i < record.output_count; ++i) {
      record.outputs[output_place(record.output_count, i)] =
          static_cast<std::uint16_t>(network.outputs_[i]);
    }
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

mien_error_detail MienWriter::finish(std::vector<std::byte>* file) const {
  file->clear();
  FileSections sections;
  if (const mien_status status = add_networks(&sections); status != MIEN_OK) {
    return detail_of(status);
  }
  add_tensors(&sections);
  for (const auto& [key, value] : metadata_) {
    const StringRef name = sections.add_string(key);
    sections.metadata.push_back({name, sections.add_string(value)});
  }
  std::vector<std::byte> bytes = assembled(std::move(sections));
  const mien_error_detail validation = validated(bytes);
  if (validation.status == MIEN_OK) {
    *file = std::move(bytes);
  }
  return validation;
}

}  // namespace mien::formats
