// The validating pass over a weight file, section by section in the order of docs/format.md.
// mien_open.cpp has the rules of the file, its strings and tensors, mien_open_networks.cpp those of
// networks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "formats/mien_file.h"
#include "formats/mien_layers.h"

namespace mien::formats {

[[nodiscard]] inline DataType type_of(const TensorRecord& tensor) {
  return static_cast<DataType>(tensor.type);
}

// Each step returns false after it has described the error.
class Validator {
 public:
  explicit Validator(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool run() {
    return whole_file() && checksum() && sections() && strings() && tensors() && networks();
  }
  [[nodiscard]] const mien_error_detail& result() const { return result_; }

  // Requires a file of at least this size.
  [[nodiscard]] const FileHeader& header() const {
    return *reinterpret_cast<const FileHeader*>(bytes_.data());
  }
  std::span<const NetworkRecord> network_records;
  std::span<const LayerRecord> layer_records;
  std::span<const TensorRecord> tensor_records;
  std::span<const MetadataRecord> metadata_records;
  std::string_view string_section;

 private:
  bool fail(mien_status status, std::uint64_t offset, const char* field = nullptr);
  bool fail_in_file(mien_status status, const void* field, const char* name);
  // `field` must lie in the file.
  template <class Field>
  bool fail_at(mien_status status, const Field& field, const char* name) {
    fail_in_file(status, &field, name);
    if constexpr (std::is_arithmetic_v<Field>) {
      set_got(result_, static_cast<double>(field));
    }
    return false;
  }
  // The field should be in min..max.
  template <class Field>
  bool fail_at(mien_status status, const Field& field, const char* name, std::uint64_t min,
               std::uint64_t max) {
    fail_in_file(status, &field, name);
    set_got(result_, static_cast<double>(field));
    return expect(min, max);
  }
  bool expect(std::uint64_t min, std::uint64_t max);

  [[nodiscard]] std::span<const std::byte> part(std::uint64_t begin, std::uint64_t bytes) const {
    return bytes_.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(bytes));
  }

  bool whole_file();
  bool version();
  bool size();
  bool counts();
  bool count(const std::uint32_t& field, const char* name, std::uint32_t min, std::uint32_t max);
  bool truncated(std::uint64_t bytes);
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
  bool outputs(const NetworkRecord& record);
  bool layer(const NetworkRecord& network, std::uint32_t index);
  bool layer_fields(const NetworkRecord& network, const LayerRecord& record);
  bool layer_shape(const LayerRecord& record, const ValueShape& output);
  bool layer_tensor(const std::uint32_t& index, const LayerTensor& tensor, const char* field);
  bool tensor_matches(const std::uint32_t& index, const TensorRecord& record,
                      const TensorDims& dims, const char* field);
  bool constants();
  [[nodiscard]] ValueShape value_shape(const NetworkRecord& network, std::uint32_t value) const;

  std::span<const std::byte> bytes_;
  std::uint64_t next_byte_ = 0;    // end of the sections and tensors checked so far
  std::uint64_t next_string_ = 0;  // likewise in the string section
  std::uint32_t next_layer_ = 0;
  std::uint32_t next_tensor_ = 0;
  std::uint16_t version_needed_ = 0;  // minor version, from the layers so far
  std::int32_t network_ = -1;         // that is being checked; -1: none
  std::int32_t layer_ = -1;           // likewise, in its network
  mien_error_detail result_ = detail_of(MIEN_OK);
};

}  // namespace mien::formats
