// The rules of a weight file as a whole, of its strings and tensors.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "formats/byte_checks.h"
#include "formats/checked.h"
#include "formats/mien_validator.h"
#include "formats/text.h"
#include "formats/xxhash64.h"

namespace mien::formats {
namespace {

std::uint64_t element_bytes(DataType type) { return type == DataType::kFloat16 ? 2 : 4; }

}  // namespace

bool Validator::fail(mien_status status, std::uint64_t offset, const char* field) {
  describe(result_, status, field);
  result_.network = network_;
  result_.layer = layer_;
  if (network_ >= 0) {
    const StringRef name = network_records[static_cast<std::size_t>(network_)].name;
    set_name(result_, string_section.substr(name.offset, name.bytes));
  }
  set_offset(result_, offset);
  return false;
}

bool Validator::fail_in_file(mien_status status, const void* field, const char* name) {
  const auto at = static_cast<const std::byte*>(field) - bytes_.data();
  return fail(status, static_cast<std::uint64_t>(at), name);
}

bool Validator::expect(std::uint64_t min, std::uint64_t max) {
  set_expected(result_, static_cast<double>(min), static_cast<double>(max));
  return false;
}

bool Validator::whole_file() {
  if (reinterpret_cast<std::uintptr_t>(bytes_.data()) % kFileAlignment != 0) {
    return fail(MIEN_ERROR_ALIGNMENT, 0);
  }
  if (bytes_.size() < sizeof(FileHeader)) {
    return truncated(sizeof(FileHeader));
  }
  return version() && size() && counts();
}

bool Validator::version() {
  for (std::size_t i = 0; i < sizeof kMagic; ++i) {
    if (header().magic[i] != kMagic[i]) {
      return fail_at(MIEN_ERROR_WEIGHTS_NOT_MIEN, header().magic[i], "magic", kMagic[i], kMagic[i]);
    }
  }
  if (header().endian_tag != kEndianTag) {
    return fail_at(MIEN_ERROR_WEIGHTS_BYTE_ORDER, header().endian_tag, "endian_tag");
  }
  if (header().major_version != kMajorVersion) {
    return fail_at(MIEN_ERROR_WEIGHTS_VERSION, header().major_version, "major_version",
                   kMajorVersion, kMajorVersion);
  }
  if (header().minor_version > kMinorVersion) {
    fail(MIEN_ERROR_WEIGHTS_VERSION, offsetof(FileHeader, major_version), "minor_version");
    set_got(result_, header().minor_version);
    return expect(0, kMinorVersion);
  }
  if (header().header_bytes != sizeof(FileHeader)) {
    return fail_at(MIEN_ERROR_WEIGHTS_VERSION, header().header_bytes, "header_bytes",
                   sizeof(FileHeader), sizeof(FileHeader));
  }
  return true;
}

bool Validator::size() {
  if (header().total_bytes > kMaxFileBytes) {
    return fail_at(MIEN_ERROR_WEIGHTS_LIMIT, header().total_bytes, "total_bytes", 0, kMaxFileBytes);
  }
  if (header().total_bytes > bytes_.size()) {
    return truncated(header().total_bytes);
  }
  if (header().total_bytes < bytes_.size()) {
    fail(MIEN_ERROR_WEIGHTS_TRAILING_BYTES, header().total_bytes, "file");
    set_got(result_, static_cast<double>(bytes_.size()));
    return expect(header().total_bytes, header().total_bytes);
  }
  return true;
}

bool Validator::counts() {
  return count(header().network_count, "network_count", 1, kMaxNetworks) &&
         count(header().layer_count, "layer_count", 0, kMaxLayers) &&
         count(header().tensor_count, "tensor_count", 0, kMaxTensors) &&
         count(header().metadata_count, "metadata_count", 0, kMaxMetadata);
}

bool Validator::count(const std::uint32_t& field, const char* name, std::uint32_t min,
                      std::uint32_t max) {
  return (field >= min && field <= max) || fail_at(MIEN_ERROR_WEIGHTS_LIMIT, field, name, min, max);
}

// The file should have `bytes` bytes.
bool Validator::truncated(std::uint64_t bytes) {
  fail(MIEN_ERROR_WEIGHTS_TRUNCATED, bytes_.size(), "file");
  set_got(result_, static_cast<double>(bytes_.size()));
  return expect(bytes, bytes);
}

bool Validator::checksum() {
  if (xxhash64_with_hole(bytes_, offsetof(FileHeader, checksum)) != header().checksum) {
    return fail(MIEN_ERROR_WEIGHTS_CHECKSUM, offsetof(FileHeader, checksum), "checksum");
  }
  return true;
}

template <class Record>
bool Validator::section(std::uint32_t count, std::span<const Record>* records) {
  const Checked end = Checked(next_byte_) + Checked(count) * sizeof(Record);
  if (end.value() > bytes_.size()) {
    return truncated(end.value());
  }
  *records = {reinterpret_cast<const Record*>(bytes_.data() + next_byte_), count};
  next_byte_ = end.value();
  return true;
}

bool Validator::sections() {
  std::span<const char> characters;
  next_byte_ = sizeof(FileHeader);
  if (!section(header().network_count, &network_records) ||
      !section(header().layer_count, &layer_records) ||
      !section(header().tensor_count, &tensor_records) ||
      !section(header().metadata_count, &metadata_records) ||
      !section(header().string_bytes, &characters)) {
    return false;
  }
  string_section = {characters.data(), characters.size()};
  const Checked data = Checked(next_byte_).aligned(kFileAlignment);
  if (data.value() != header().data_offset || data.value() > bytes_.size()) {
    return fail_at(MIEN_ERROR_WEIGHTS_GAP, header().data_offset, "data_offset", data.value(),
                   data.value());
  }
  return padding(next_byte_, header().data_offset);
}

bool Validator::padding(std::uint64_t begin, std::uint64_t end) {
  if (!all_zero(part(begin, end - begin))) {
    return fail(MIEN_ERROR_WEIGHTS_PADDING, begin, "padding");
  }
  next_byte_ = end;
  return true;
}

bool Validator::strings() {
  if (!names() || !metadata()) {
    return false;
  }
  if (next_string_ != string_section.size()) {
    return fail_at(MIEN_ERROR_WEIGHTS_GAP, header().string_bytes, "string_bytes", next_string_,
                   next_string_);
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
      return fail_at(MIEN_ERROR_WEIGHTS_METADATA, record.value, "value");
    }
  }
  return true;
}

// Strings must be in the order of their records, so that they neither overlap nor leave gaps.
bool Validator::string(const StringRef& ref) {
  if (ref.offset != next_string_ || ref.bytes > string_section.size() - next_string_) {
    return fail_at(MIEN_ERROR_WEIGHTS_GAP, ref.offset, "string offset", next_string_, next_string_);
  }
  next_string_ += ref.bytes;
  return true;
}

bool Validator::name(const StringRef& ref) {
  if (!string(ref)) {
    return false;
  }
  if (ref.bytes > kMaxNameBytes || !is_name(string_section.substr(ref.offset, ref.bytes))) {
    return fail_at(MIEN_ERROR_WEIGHTS_NAME, ref, "name");
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
        return fail_at(MIEN_ERROR_WEIGHTS_DUPLICATE_NAME, records[i].*name, "name");
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
    return fail(MIEN_ERROR_WEIGHTS_GAP, next_byte_, "tensors");
  }
  return true;
}

bool Validator::tensor(const TensorRecord& record) {
  if (type_of(record) != DataType::kFloat16 && type_of(record) != DataType::kFloat32) {
    return fail_at(MIEN_ERROR_WEIGHTS_TENSOR_TYPE, record.type, "type");
  }
  if (!is_zero(record.reserved)) {
    return fail_at(MIEN_ERROR_WEIGHTS_RESERVED, record.reserved, "reserved");
  }
  if (!is_zero(record.reserved_tail)) {
    return fail_at(MIEN_ERROR_WEIGHTS_RESERVED, record.reserved_tail, "reserved_tail");
  }
  return dims(record) && tensor_data(record);
}

bool Validator::dims(const TensorRecord& record) {
  if (record.rank == 0 || record.rank > kMaxRank) {
    return fail_at(MIEN_ERROR_WEIGHTS_TENSOR_DIMS, record.rank, "rank", 1, kMaxRank);
  }
  Checked bytes = element_bytes(type_of(record));
  for (std::uint32_t i = 0; i < kMaxRank; ++i) {
    const std::uint32_t& dim = record.dims[i];
    const bool used = i < record.rank;
    if (used ? (dim == 0 || dim > kMaxDim) : dim != 0) {
      return fail_at(MIEN_ERROR_WEIGHTS_TENSOR_DIMS, dim, "dims", used ? 1 : 0, used ? kMaxDim : 0);
    }
    bytes = used ? bytes * dim : bytes;
  }
  // An overflow reads as 2^64 - 1, which exceeds every file size.
  if (bytes.value() != record.bytes || bytes.value() > kMaxFileBytes) {
    return fail_at(MIEN_ERROR_WEIGHTS_TENSOR_BYTES, record.bytes, "bytes", bytes.value(),
                   bytes.value());
  }
  return true;
}

bool Validator::tensor_data(const TensorRecord& record) {
  if (record.offset != next_byte_) {
    return fail_at(MIEN_ERROR_WEIGHTS_GAP, record.offset, "offset", next_byte_, next_byte_);
  }
  const Checked end = Checked(record.offset) + record.bytes;
  const Checked padded = end.aligned(kFileAlignment);
  if (padded.value() > bytes_.size()) {
    return truncated(padded.value());
  }
  const auto data = part(record.offset, record.bytes);
  const bool finite = type_of(record) == DataType::kFloat16
                          ? all_finite<std::uint16_t>(data, 0x7C00)
                          : all_finite<std::uint32_t>(data, 0x7F800000);
  if (!finite) {
    return fail(MIEN_ERROR_WEIGHTS_TENSOR_VALUE, record.offset, "tensor");
  }
  return padding(end.value(), padded.value());
}

mien_error_detail open(std::span<const std::byte> bytes, FileView& view) {
  view = FileView();
  Validator validator(bytes);
  if (validator.run()) {
    view.bytes_ = bytes;
    view.networks_ = validator.network_records;
    view.layers_ = validator.layer_records;
    view.tensors_ = validator.tensor_records;
    view.metadata_ = validator.metadata_records;
    view.strings_ = validator.string_section;
    view.checksum_ = validator.header().checksum;
  }
  return validator.result();
}

}  // namespace mien::formats
