#include "formats/mien_file.h"

#include <bit>

#include "formats/checked.h"
#include "formats/mien_layers.h"
#include "formats/xxhash64.h"

namespace mien::formats {

const char* message(FileStatus status) {
  switch (status) {
    case FileStatus::kOk:
      return "ok";
    case FileStatus::kMisaligned:
      return "the file is not aligned to 64 bytes in memory";
    case FileStatus::kTruncated:
      return "the file is shorter than it says";
    case FileStatus::kTrailingBytes:
      return "there are bytes after the end of the file";
    case FileStatus::kBadMagic:
      return "not a .mien file";
    case FileStatus::kUnsupportedVersion:
      return "a version of the format that is not supported";
    case FileStatus::kWrongEndian:
      return "the file's byte order is not this machine's";
    case FileStatus::kBadChecksum:
      return "the checksum does not match: the file is damaged";
    case FileStatus::kLimitExceeded:
      return "a count or size exceeds the format's limits";
    case FileStatus::kReservedNotZero:
      return "a reserved field is not zero";
    case FileStatus::kHole:
      return "a section or tensor does not begin where the one before it ends";
    case FileStatus::kPaddingNotZero:
      return "padding bytes are not zero";
    case FileStatus::kBadName:
      return "a name is empty, too long, or has other characters than a-z 0-9 _ . /";
    case FileStatus::kDuplicateName:
      return "two networks or two constants have the same name";
    case FileStatus::kBadMetadata:
      return "a metadata key or value is too long or not text";
    case FileStatus::kBadType:
      return "unknown data type";
    case FileStatus::kBadDims:
      return "rank or dimensions of a tensor are out of range";
    case FileStatus::kBadTensorBytes:
      return "a tensor's bytes are not its dimensions times its type's size";
    case FileStatus::kNonFinite:
      return "a tensor holds an infinity or a NaN";
    case FileStatus::kBadNetwork:
      return "a network's input, flags, layers or outputs are out of range";
    case FileStatus::kBadOp:
      return "unknown layer operation";
    case FileStatus::kBadActivation:
      return "unknown activation, or one the operation cannot have";
    case FileStatus::kBadReference:
      return "a layer refers to a value that is not before it";
    case FileStatus::kBadShape:
      return "a layer's output shape is out of range";
    case FileStatus::kBadKernel:
      return "kernel, stride or padding of a layer are out of range";
    case FileStatus::kBadTensor:
      return "a layer's tensors are not those its operation asks for";
    case FileStatus::kUnusedTensor:
      return "a tensor belongs to no layer and has no name";
  }
  return "unknown status";
}

namespace {

template <class Record>
std::span<const Record> records(std::span<const std::byte> bytes, std::uint64_t offset,
                                std::uint32_t count) {
  return {reinterpret_cast<const Record*>(bytes.data() + offset), count};
}

bool all_zero(std::span<const std::byte> bytes) {
  for (const std::byte one : bytes) {
    if (one != std::byte{0}) {
      return false;
    }
  }
  return true;
}

bool is_name(std::string_view text) {
  if (text.empty() || text.size() > kMaxNameBytes) {
    return false;
  }
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (!letter && c != '_' && c != '.' && c != '/') {
      return false;
    }
  }
  return true;
}

// Metadata is for people: any UTF-8, no control characters but newline and tab.
bool is_text(std::string_view text, std::size_t longest) {
  if (text.size() > longest) {
    return false;
  }
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') {
      return false;
    }
  }
  return true;
}

std::size_t element_bytes(std::uint16_t type) {
  return type == static_cast<std::uint16_t>(DataType::kFloat16) ? 2 : 4;
}

// All exponent bits set: an infinity or a NaN.
bool all_finite(std::span<const std::byte> data, std::uint16_t type) {
  if (element_bytes(type) == 2) {
    const auto* values = reinterpret_cast<const std::uint16_t*>(data.data());
    for (std::size_t i = 0; i < data.size() / 2; ++i) {
      if ((values[i] & 0x7C00u) == 0x7C00u) {
        return false;
      }
    }
    return true;
  }
  const auto* values = reinterpret_cast<const std::uint32_t*>(data.data());
  for (std::size_t i = 0; i < data.size() / 4; ++i) {
    if ((values[i] & 0x7F800000u) == 0x7F800000u) {
      return false;
    }
  }
  return true;
}

}  // namespace

// Walks the file once, front to back. Every check returns false after noting what failed where.
class Validator {
 public:
  explicit Validator(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool run() {
    return whole_file() && sections() && strings() && tensors() && networks() && checksum();
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
  template <class Pointer>
  [[nodiscard]] std::uint64_t offset_of(const Pointer* record) const {
    return static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(record) - bytes_.data());
  }

  bool whole_file();
  bool counts();
  bool sections();
  bool section_end(Checked end, std::uint64_t& next);
  bool padding(std::uint64_t begin, std::uint64_t end);
  bool strings();
  bool string(StringRef ref, const void* record, std::uint64_t& next);
  bool unique_names();
  bool tensors();
  bool tensor(const TensorRecord& record, std::uint64_t& next);
  bool networks();
  bool network(const NetworkRecord& record, std::uint32_t& next_layer, std::uint32_t& next_tensor);
  bool layer(const NetworkRecord& network, std::uint32_t index, std::uint32_t& next_tensor);
  bool layer_tensors(const NetworkRecord& network, std::uint32_t index, std::uint32_t& next_tensor);
  bool checksum();

  std::span<const std::byte> bytes_;
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
  for (std::size_t i = 0; i < sizeof kMagic; ++i) {
    if (header.magic[i] != kMagic[i]) {
      return fail(FileStatus::kBadMagic, i);
    }
  }
  if (header.endian_tag != kEndianTag) {
    return fail(FileStatus::kWrongEndian, offsetof(FileHeader, endian_tag));
  }
  if (header.major_version != kMajorVersion || header.minor_version > kMinorVersion ||
      header.header_bytes != sizeof(FileHeader)) {
    return fail(FileStatus::kUnsupportedVersion, offsetof(FileHeader, major_version));
  }
  if (header.total_bytes > kMaxFileBytes) {
    return fail(FileStatus::kLimitExceeded, offsetof(FileHeader, total_bytes));
  }
  if (header.total_bytes > bytes_.size()) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  if (header.total_bytes < bytes_.size()) {
    return fail(FileStatus::kTrailingBytes, header.total_bytes);
  }
  return counts();
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

bool Validator::section_end(Checked end, std::uint64_t& next) {
  if (end.value() > bytes_.size()) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  next = end.value();
  return true;
}

bool Validator::padding(std::uint64_t begin, std::uint64_t end) {
  if (!all_zero(bytes_.subspan(begin, end - begin))) {
    return fail(FileStatus::kPaddingNotZero, begin);
  }
  return true;
}

// Header, networks, layers, tensors, metadata, strings: one after the other, then padding.
bool Validator::sections() {
  std::uint64_t at = sizeof(FileHeader);
  std::uint64_t next = 0;
  if (!section_end(Checked(at) + Checked(header.network_count) * sizeof(NetworkRecord), next)) {
    return false;
  }
  network_records = records<NetworkRecord>(bytes_, at, header.network_count);
  at = next;
  if (!section_end(Checked(at) + Checked(header.layer_count) * sizeof(LayerRecord), next)) {
    return false;
  }
  layer_records = records<LayerRecord>(bytes_, at, header.layer_count);
  at = next;
  if (!section_end(Checked(at) + Checked(header.tensor_count) * sizeof(TensorRecord), next)) {
    return false;
  }
  tensor_records = records<TensorRecord>(bytes_, at, header.tensor_count);
  at = next;
  if (!section_end(Checked(at) + Checked(header.metadata_count) * sizeof(MetadataRecord), next)) {
    return false;
  }
  metadata_records = records<MetadataRecord>(bytes_, at, header.metadata_count);
  at = next;
  if (!section_end(Checked(at) + header.string_bytes, next)) {
    return false;
  }
  string_section = {reinterpret_cast<const char*>(bytes_.data() + at), header.string_bytes};
  const Checked data = Checked(next).aligned(kFileAlignment);
  if (data.value() != header.data_offset || data.value() > bytes_.size()) {
    return fail(FileStatus::kHole, offsetof(FileHeader, data_offset));
  }
  return padding(next, header.data_offset);
}

// Strings lie in the order of the records that own them, so that none overlaps or hides.
bool Validator::string(StringRef ref, const void* record, std::uint64_t& next) {
  const auto* at = static_cast<const std::byte*>(record);
  if (ref.offset != next) {
    return fail(FileStatus::kHole, offset_of(at));
  }
  next = (Checked(next) + ref.bytes).value();
  if (next > string_section.size()) {
    return fail(FileStatus::kHole, offset_of(at));
  }
  return true;
}

bool Validator::strings() {
  std::uint64_t next = 0;
  for (const NetworkRecord& record : network_records) {
    if (!string(record.name, &record, next)) {
      return false;
    }
    if (!is_name(string_section.substr(record.name.offset, record.name.bytes))) {
      return fail(FileStatus::kBadName, offset_of(&record));
    }
  }
  for (const TensorRecord& record : tensor_records) {
    if (!string(record.name, &record, next)) {
      return false;
    }
    if (record.name.bytes != 0 &&
        !is_name(string_section.substr(record.name.offset, record.name.bytes))) {
      return fail(FileStatus::kBadName, offset_of(&record));
    }
  }
  for (const MetadataRecord& record : metadata_records) {
    if (!string(record.key, &record, next) || !string(record.value, &record, next)) {
      return false;
    }
    const std::string_view key = string_section.substr(record.key.offset, record.key.bytes);
    const std::string_view value = string_section.substr(record.value.offset, record.value.bytes);
    if (!is_name(key) || !is_text(value, kMaxValueBytes)) {
      return fail(FileStatus::kBadMetadata, offset_of(&record));
    }
  }
  if (next != string_section.size()) {
    return fail(FileStatus::kHole, offsetof(FileHeader, string_bytes));
  }
  return unique_names();
}

bool Validator::unique_names() {
  const auto text = [&](StringRef ref) { return string_section.substr(ref.offset, ref.bytes); };
  for (const NetworkRecord& record : network_records) {
    for (const NetworkRecord* other = network_records.data(); other != &record; ++other) {
      if (text(other->name) == text(record.name)) {
        return fail(FileStatus::kDuplicateName, offset_of(&record));
      }
    }
  }
  for (const TensorRecord& record : tensor_records) {
    for (const TensorRecord* other = tensor_records.data(); other != &record; ++other) {
      if (record.name.bytes != 0 && text(other->name) == text(record.name)) {
        return fail(FileStatus::kDuplicateName, offset_of(&record));
      }
    }
  }
  for (const MetadataRecord& record : metadata_records) {
    for (const MetadataRecord* other = metadata_records.data(); other != &record; ++other) {
      if (text(other->key) == text(record.key)) {
        return fail(FileStatus::kDuplicateName, offset_of(&record));
      }
    }
  }
  return true;
}

bool Validator::tensor(const TensorRecord& record, std::uint64_t& next) {
  if (record.type != static_cast<std::uint16_t>(DataType::kFloat16) &&
      record.type != static_cast<std::uint16_t>(DataType::kFloat32)) {
    return fail(FileStatus::kBadType, offset_of(&record.type));
  }
  if (record.rank == 0 || record.rank > kMaxRank) {
    return fail(FileStatus::kBadDims, offset_of(&record.rank));
  }
  Checked size = element_bytes(record.type);
  for (std::uint32_t i = 0; i < kMaxRank; ++i) {
    const bool used = i < record.rank;
    if (used ? (record.dims[i] == 0 || record.dims[i] > kMaxDim) : record.dims[i] != 0) {
      return fail(FileStatus::kBadDims, offset_of(&record.dims[i]));
    }
    size = used ? size * record.dims[i] : size;
  }
  if (size.value() != record.bytes) {
    return fail(FileStatus::kBadTensorBytes, offset_of(&record.bytes));
  }
  if (record.offset != next) {
    return fail(FileStatus::kHole, offset_of(&record.offset));
  }
  const std::uint64_t end = (Checked(record.offset) + size).value();
  const std::uint64_t padded = Checked(end).aligned(kFileAlignment).value();
  if (padded > bytes_.size()) {
    return fail(FileStatus::kTruncated, bytes_.size());
  }
  if (record.reserved != 0 || !all_zero(std::as_bytes(std::span(record.reserved_tail)))) {
    return fail(FileStatus::kReservedNotZero, offset_of(&record));
  }
  if (!all_finite(bytes_.subspan(record.offset, record.bytes), record.type)) {
    return fail(FileStatus::kNonFinite, record.offset);
  }
  next = padded;
  return padding(end, padded);
}

bool Validator::tensors() {
  std::uint64_t next = header.data_offset;
  for (const TensorRecord& record : tensor_records) {
    if (!tensor(record, next)) {
      return false;
    }
  }
  if (next != bytes_.size()) {
    return fail(FileStatus::kHole, next);
  }
  return true;
}

bool Validator::networks() {
  std::uint32_t next_layer = 0;
  std::uint32_t next_tensor = 0;
  for (const NetworkRecord& record : network_records) {
    if (!network(record, next_layer, next_tensor)) {
      return false;
    }
  }
  if (next_layer != header.layer_count) {
    return fail(FileStatus::kBadNetwork, offsetof(FileHeader, layer_count));
  }
  // The layers' tensors come first, in the order of their use; what is left are constants.
  for (; next_tensor < header.tensor_count; ++next_tensor) {
    if (tensor_records[next_tensor].name.bytes == 0) {
      return fail(FileStatus::kUnusedTensor, offset_of(&tensor_records[next_tensor]));
    }
  }
  return true;
}

bool Validator::network(const NetworkRecord& record, std::uint32_t& next_layer,
                        std::uint32_t& next_tensor) {
  const auto in_range = [](std::uint32_t dim) { return dim >= 1 && dim <= kMaxDim; };
  const Checked input =
      Checked(record.input_height) * record.input_width * (Checked(record.input_channels) + 7);
  if (!in_range(record.input_height) || !in_range(record.input_width) ||
      !in_range(record.input_channels) || input.value() > kMaxFileBytes ||
      record.flags > kAnySize || record.first_layer != next_layer || record.layer_count == 0 ||
      record.layer_count > header.layer_count - next_layer || record.output_count == 0 ||
      record.output_count > kMaxOutputs) {
    return fail(FileStatus::kBadNetwork, offset_of(&record));
  }
  for (std::uint32_t i = 0; i < kMaxOutputs; ++i) {
    const bool used = i < record.output_count;
    if (used ? (record.outputs[i] == 0 || record.outputs[i] > record.layer_count)
             : record.outputs[i] != 0) {
      return fail(FileStatus::kBadNetwork, offset_of(&record.outputs[i]));
    }
  }
  if (!all_zero(std::as_bytes(std::span(record.reserved)))) {
    return fail(FileStatus::kReservedNotZero, offset_of(&record.reserved[0]));
  }
  next_layer += record.layer_count;
  for (std::uint32_t i = 0; i < record.layer_count; ++i) {
    if (!layer(record, i, next_tensor)) {
      return false;
    }
  }
  return true;
}

bool Validator::layer(const NetworkRecord& network, std::uint32_t index,
                      std::uint32_t& next_tensor) {
  const LayerRecord& record = layer_records[network.first_layer + index];
  const FileStatus status = check_layer(record, index + 1);
  if (status != FileStatus::kOk) {
    return fail(status, offset_of(&record));
  }
  return layer_tensors(network, index, next_tensor);
}

bool Validator::layer_tensors(const NetworkRecord& network, std::uint32_t index,
                              std::uint32_t& next_tensor) {
  const LayerRecord& record = layer_records[network.first_layer + index];
  const ValueShape input =
      record.input == 0
          ? ValueShape{network.input_height, network.input_width, network.input_channels}
          : shape_of(layer_records[network.first_layer + record.input - 1]);
  const LayerTensors wanted = tensors_of(record, input);
  const std::uint32_t given[3] = {record.weights, record.bias, record.slopes};
  for (std::size_t i = 0; i < 3; ++i) {
    const TensorDims& dims = wanted.dims[i];
    if (dims.rank == 0) {
      if (given[i] != kNoIndex) {
        return fail(FileStatus::kBadTensor, offset_of(&record));
      }
      continue;
    }
    if (given[i] != next_tensor || next_tensor >= header.tensor_count) {
      return fail(FileStatus::kBadTensor, offset_of(&record));
    }
    const TensorRecord& tensor = tensor_records[next_tensor++];
    bool same = tensor.type == static_cast<std::uint16_t>(DataType::kFloat16) &&
                tensor.rank == dims.rank && tensor.name.bytes == 0;
    for (std::uint32_t k = 0; k < dims.rank; ++k) {
      same = same && tensor.dims[k] == dims.dim[k];
    }
    if (!same) {
      return fail(FileStatus::kBadTensor, offset_of(&tensor));
    }
  }
  return true;
}

bool Validator::checksum() {
  if (xxhash64_with_hole(bytes_, offsetof(FileHeader, checksum)) != header.checksum) {
    return fail(FileStatus::kBadChecksum, offsetof(FileHeader, checksum));
  }
  return true;
}

Validation open(std::span<const std::byte> bytes, FileView& view) {
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

const NetworkRecord* FileView::find_network(std::string_view name) const {
  for (const NetworkRecord& record : networks_) {
    if (text(record.name) == name) {
      return &record;
    }
  }
  return nullptr;
}

const TensorRecord* FileView::find_constant(std::string_view name) const {
  for (const TensorRecord& record : tensors_) {
    if (record.name.bytes != 0 && text(record.name) == name) {
      return &record;
    }
  }
  return nullptr;
}

}  // namespace mien::formats
