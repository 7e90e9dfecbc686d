// The validating pass over a weight file, section by section in the order of docs/format.md.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "formats/byte_checks.h"
#include "formats/checked.h"
#include "formats/mien_file.h"
#include "formats/mien_layers.h"
#include "formats/text.h"
#include "formats/xxhash64.h"

namespace mien::formats {
namespace {

DataType type_of(const TensorRecord& tensor) { return static_cast<DataType>(tensor.type); }

std::uint64_t element_bytes(DataType type) { return type == DataType::kFloat16 ? 2 : 4; }

// Each step returns false after it has recorded the fault and its position.
class Validator {
 public:
  explicit Validator(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool run() {
    return whole_file() && checksum() && sections() && strings() && tensors() && networks();
  }
  [[nodiscard]] const Validation& result() const { return result_; }

  FileHeader header{};
  std::span<const NetworkRecord> network_records;
  std::span<const LayerRecord> layer_records;
  std::span<const TensorRecord> tensor_records;
  std::span<const MetadataRecord> metadata_records;
  std::string_view string_section;

 private:
  bool fail(FileStatus status, std::uint64_t offset) {
    result_ = {status, offset};
    return false;
  }
  // `field` must lie in the file.
  template <class Field>
  bool fail_at(FileStatus status, const Field& field) {
    const auto* at = reinterpret_cast<const std::byte*>(&field);
    return fail(status, static_cast<std::uint64_t>(at - bytes_.data()));
  }

  [[nodiscard]] std::span<const std::byte> part(std::uint64_t begin, std::uint64_t bytes) const {
    return bytes_.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(bytes));
  }

  bool whole_file();
  bool version();
  bool size();
  bool counts();
  bool checksum();
  bool sections();
  template <class Record>
  bool section(std::uint32_t count, std::span<const Record>* records);
  bool strings();
  bool names();
  bool metadata();
  bool string(const StringRef& ref);
  bool name(const StringRef& ref);
  template <class Record>
  bool unique(std::span<const Record> records, StringRef Record::*name);
  bool tensors();
  bool tensor(const TensorRecord& record);
  bool dims(const TensorRecord& record);
  bool tensor_data(const TensorRecord& record);
  bool padding(std::uint64_t begin, std::uint64_t end);
  bool networks();
  bool network(const NetworkRecord& record);
  bool layer(const NetworkRecord& network, std::uint32_t index);
  bool layer_tensor(const std::uint32_t& index, const LayerTensor& tensor);
  bool constants();
  [[nodiscard]] ValueShape value_shape(const NetworkRecord& network, std::uint32_t value) const;

  std::span<const std::byte> bytes_;
  std::uint64_t next_byte_ = 0;    // end of the sections and tensors checked so far
  std::uint64_t next_string_ = 0;  // likewise in the string section
  std::uint32_t next_layer_ = 0;
  std::uint32_t next_tensor_ = 0;
  std::uint16_t version_needed_ = 0;  // minor version, from the layers so far
  Validation result_;
};

bool Validator::whole_file() {
  if (reinterpret_cast<std::uintptr_t>(bytes_.data()) % kFileAlignment != 0) {
    return fail(FileStatus::kMisaligned, 0);
  }
  if (bytes_.size() < sizeof(FileHeader)) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  header = *reinterpret_cast<const FileHeader*>(bytes_.data());
  return version() && size() && counts();
}

bool Validator::version() {
  for (std::size_t i = 0; i < sizeof kMagic; ++i) {
    if (header.magic[i] != kMagic[i]) {
      return fail(FileStatus::kBadMagic, i);
    }
  }
  if (header.endian_tag != kEndianTag) {
    return fail(FileStatus::kWrongEndian, offsetof(FileHeader, endian_tag));
  }
  if (header.major_version != kMajorVersion || header.minor_version > kMinorVersion) {
    return fail(FileStatus::kUnsupportedVersion, offsetof(FileHeader, major_version));
  }
  if (header.header_bytes != sizeof(FileHeader)) {
    return fail(FileStatus::kUnsupportedVersion, offsetof(FileHeader, header_bytes));
  }
  return true;
}

bool Validator::size() {
  if (header.total_bytes > kMaxFileBytes) {
    return fail(FileStatus::kLimitExceeded, offsetof(FileHeader, total_bytes));
  }
  if (header.total_bytes > bytes_.size()) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  if (header.total_bytes < bytes_.size()) {
    return fail(FileStatus::kTrailingBytes, header.total_bytes);
  }
  return true;
}

bool Validator::counts() {
  if (header.network_count == 0 || header.network_count > kMaxNetworks) {
    return fail(FileStatus::kLimitExceeded, offsetof(FileHeader, network_count));
  }
  if (header.layer_count > kMaxLayers) {
    return fail(FileStatus::kLimitExceeded, offsetof(FileHeader, layer_count));
  }
  if (header.tensor_count > kMaxTensors) {
    return fail(FileStatus::kLimitExceeded, offsetof(FileHeader, tensor_count));
  }
  if (header.metadata_count > kMaxMetadata) {
    return fail(FileStatus::kLimitExceeded, offsetof(FileHeader, metadata_count));
  }
  return true;
}

bool Validator::checksum() {
  if (xxhash64_with_hole(bytes_, offsetof(FileHeader, checksum)) != header.checksum) {
    return fail(FileStatus::kBadChecksum, offsetof(FileHeader, checksum));
  }
  return true;
}

template <class Record>
bool Validator::section(std::uint32_t count, std::span<const Record>* records) {
  const Checked end = Checked(next_byte_) + Checked(count) * sizeof(Record);
  if (end.value() > bytes_.size()) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  *records = {reinterpret_cast<const Record*>(bytes_.data() + next_byte_), count};
  next_byte_ = end.value();
  return true;
}

bool Validator::sections() {
  std::span<const char> characters;
  next_byte_ = sizeof(FileHeader);
  if (!section(header.network_count, &network_records) ||
      !section(header.layer_count, &layer_records) ||
      !section(header.tensor_count, &tensor_records) ||
      !section(header.metadata_count, &metadata_records) ||
      !section(header.string_bytes, &characters)) {
    return false;
  }
  string_section = {characters.data(), characters.size()};
  const Checked data = Checked(next_byte_).aligned(kFileAlignment);
  if (data.value() != header.data_offset || data.value() > bytes_.size()) {
    return fail(FileStatus::kHole, offsetof(FileHeader, data_offset));
  }
  return padding(next_byte_, header.data_offset);
}

bool Validator::padding(std::uint64_t begin, std::uint64_t end) {
  if (!all_zero(part(begin, end - begin))) {
    return fail(FileStatus::kPaddingNotZero, begin);
  }
  next_byte_ = end;
  return true;
}

bool Validator::strings() {
  if (!names() || !metadata()) {
    return false;
  }
  if (next_string_ != string_section.size()) {
    return fail(FileStatus::kHole, offsetof(FileHeader, string_bytes));
  }
  return unique(network_records, &NetworkRecord::name) &&
         unique(tensor_records, &TensorRecord::name) &&
         unique(metadata_records, &MetadataRecord::key);
}

bool Validator::names() {
  for (const NetworkRecord& record : network_records) {
    if (!name(record.name)) {
      return false;
    }
  }
  for (const TensorRecord& record : tensor_records) {
    if (!(record.name.bytes == 0 ? string(record.name) : name(record.name))) {
      return false;
    }
  }
  return true;
}

bool Validator::metadata() {
  for (const MetadataRecord& record : metadata_records) {
    if (!name(record.key) || !string(record.value)) {
      return false;
    }
    if (record.value.bytes > kMaxValueBytes ||
        !is_text(string_section.substr(record.value.offset, record.value.bytes))) {
      return fail_at(FileStatus::kBadMetadata, record.value);
    }
  }
  return true;
}

// Strings must be in the order of their records, so that they neither overlap nor leave gaps.
bool Validator::string(const StringRef& ref) {
  if (ref.offset != next_string_ || ref.bytes > string_section.size() - next_string_) {
    return fail_at(FileStatus::kHole, ref);
  }
  next_string_ += ref.bytes;
  return true;
}

bool Validator::name(const StringRef& ref) {
  if (!string(ref)) {
    return false;
  }
  if (ref.bytes > kMaxNameBytes || !is_name(string_section.substr(ref.offset, ref.bytes))) {
    return fail_at(FileStatus::kBadName, ref);
  }
  return true;
}

// Ignores empty names.
template <class Record>
bool Validator::unique(std::span<const Record> records, StringRef Record::*name) {
  const auto text = [&](const Record& record) {
    return string_section.substr((record.*name).offset, (record.*name).bytes);
  };
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (std::size_t k = 0; k < i && !text(records[i]).empty(); ++k) {
      if (text(records[k]) == text(records[i])) {
        return fail_at(FileStatus::kDuplicateName, records[i].*name);
      }
    }
  }
  return true;
}

bool Validator::tensors() {
  for (const TensorRecord& record : tensor_records) {
    if (!tensor(record)) {
      return false;
    }
  }
  if (next_byte_ != bytes_.size()) {
    return fail(FileStatus::kHole, next_byte_);
  }
  return true;
}

bool Validator::tensor(const TensorRecord& record) {
  if (type_of(record) != DataType::kFloat16 && type_of(record) != DataType::kFloat32) {
    return fail_at(FileStatus::kBadType, record.type);
  }
  if (!is_zero(record.reserved)) {
    return fail_at(FileStatus::kReservedNotZero, record.reserved);
  }
  if (!is_zero(record.reserved_tail)) {
    return fail_at(FileStatus::kReservedNotZero, record.reserved_tail);
  }
  return dims(record) && tensor_data(record);
}

bool Validator::dims(const TensorRecord& record) {
  if (record.rank == 0 || record.rank > kMaxRank) {
    return fail_at(FileStatus::kBadDims, record.rank);
  }
  Checked bytes = element_bytes(type_of(record));
  for (std::uint32_t i = 0; i < kMaxRank; ++i) {
    const std::uint32_t& dim = record.dims[i];
    const bool used = i < record.rank;
    if (used ? (dim == 0 || dim > kMaxDim) : dim != 0) {
      return fail_at(FileStatus::kBadDims, dim);
    }
    bytes = used ? bytes * dim : bytes;
  }
  // An overflow reads as 2^64 - 1, which exceeds every file size.
  if (bytes.value() != record.bytes || bytes.value() > kMaxFileBytes) {
    return fail_at(FileStatus::kBadTensorBytes, record.bytes);
  }
  return true;
}

bool Validator::tensor_data(const TensorRecord& record) {
  if (record.offset != next_byte_) {
    return fail_at(FileStatus::kHole, record.offset);
  }
  const Checked end = Checked(record.offset) + record.bytes;
  const Checked padded = end.aligned(kFileAlignment);
  if (padded.value() > bytes_.size()) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  const auto data = part(record.offset, record.bytes);
  const bool finite = type_of(record) == DataType::kFloat16
                          ? all_finite<std::uint16_t>(data, 0x7C00)
                          : all_finite<std::uint32_t>(data, 0x7F800000);
  if (!finite) {
    return fail(FileStatus::kNonFinite, record.offset);
  }
  return padding(end.value(), padded.value());
}

bool Validator::networks() {
  for (const NetworkRecord& record : network_records) {
    if (!network(record)) {
      return false;
    }
  }
  if (next_layer_ != header.layer_count) {
    return fail(FileStatus::kBadNetwork, offsetof(FileHeader, layer_count));
  }
  if (version_needed_ != header.minor_version) {
    return fail(FileStatus::kUnsupportedVersion, offsetof(FileHeader, minor_version));
  }
  return constants();
}

bool Validator::network(const NetworkRecord& record) {
  if (!shape_allowed({record.input_height, record.input_width, record.input_channels})) {
    return fail_at(FileStatus::kBadNetwork, record.input_height);
  }
  if (record.flags > kAnySize) {
    return fail_at(FileStatus::kBadNetwork, record.flags);
  }
  if (record.first_layer != next_layer_ || record.layer_count == 0 ||
      record.layer_count > header.layer_count - next_layer_) {
    return fail_at(FileStatus::kBadNetwork, record.first_layer);
  }
  next_layer_ += record.layer_count;
  for (std::uint32_t i = 0; i < record.layer_count; ++i) {
    if (!layer(record, i)) {
      return false;
    }
  }
  version_needed_ = std::max(version_needed_, version_needed(record));
  std::uint32_t place = kNoIndex;
  const FileStatus status = check_outputs(record, header.minor_version, place);
  return status == FileStatus::kOk || (place == kNoIndex ? fail_at(status, record.output_count)
                                                         : fail_at(status, record.outputs[place]));
}

ValueShape Validator::value_shape(const NetworkRecord& network, std::uint32_t value) const {
  if (value == 0) {
    return {network.input_height, network.input_width, network.input_channels};
  }
  return shape_of(layer_records[network.first_layer + value - 1]);
}

bool Validator::layer(const NetworkRecord& network, std::uint32_t index) {
  const LayerRecord& record = layer_records[network.first_layer + index];
  const FileStatus status = check_layer(record, index + 1, network.flags, header.minor_version);
  if (status != FileStatus::kOk) {
    return fail_at(status, record);
  }
  version_needed_ = std::max(version_needed_, version_needed(record));
  const ValueShape input = value_shape(network, record.input);
  const bool two = takes_two(op_of(record));
  const ValueShape second = two ? value_shape(network, record.second_input) : input;
  const ValueShape output = output_shape(record, input, second);
  if (!shape_allowed(output) || output != shape_of(record)) {
    return fail_at(FileStatus::kBadShape, record.height);
  }
  const LayerTensors tensors = tensors_of(record, input);
  return layer_tensor(record.weights, tensors.weights) && layer_tensor(record.bias, tensors.bias) &&
         layer_tensor(record.slopes, tensors.slopes);
}

// Layers' tensors come first, in the order of use, so that each belongs to one layer.
bool Validator::layer_tensor(const std::uint32_t& index, const LayerTensor& tensor) {
  const TensorDims& dims = tensor.dims;
  if (dims.rank == 0) {
    return index == kNoIndex || fail_at(FileStatus::kBadTensor, index);
  }
  if (index != next_tensor_ || next_tensor_ >= header.tensor_count) {
    return fail_at(FileStatus::kBadTensor, index);
  }
  const TensorRecord& record = tensor_records[next_tensor_++];
  bool same =
      type_of(record) == DataType::kFloat16 && record.rank == dims.rank && record.name.bytes == 0;
  for (std::uint32_t i = 0; i < kMaxRank; ++i) {
    same = same && record.dims[i] == dims.dim[i];
  }
  if (!same) {
    return fail_at(FileStatus::kBadTensor, index);
  }
  const std::size_t filled = find_filled(tensor.lanes, part(record.offset, record.bytes));
  return filled == record.bytes || fail(FileStatus::kPaddingNotZero, record.offset + filled);
}

bool Validator::constants() {
  for (const TensorRecord& record : tensor_records.subspan(next_tensor_)) {
    if (record.name.bytes == 0) {
      return fail_at(FileStatus::kUnusedTensor, record.name);
    }
  }
  return true;
}

}  // namespace

Validation open(std::span<const std::byte> bytes, FileView& view) {
  view = FileView();
  Validator validator(bytes);
  if (validator.run()) {
    view.bytes_ = bytes;
    view.networks_ = validator.network_records;
    view.layers_ = validator.layer_records;
    view.tensors_ = validator.tensor_records;
    view.metadata_ = validator.metadata_records;
    view.strings_ = validator.string_section;
    view.checksum_ = validator.header.checksum;
  }
  return validator.result();
}

}  // namespace mien::formats
