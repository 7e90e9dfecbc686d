// Reads a .mien weight file where it lies: a file in memory, a mapping, an array in flash.
// docs/format.md says what is valid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "formats/file_status.h"
#include "formats/mien_format.h"

namespace mien::formats {

// A validated file. Copies nothing and owns nothing: the bytes must outlive the view and must not
// change. Records and strings handed out lie inside the file. Arguments must be records of this
// file.
class FileView {
 public:
  FileView() = default;  // an empty file: no networks, no tensors

  // One pass over all the bytes, without allocation. `bytes` is the whole file and starts at a
  // multiple of 16. On failure `*view` is empty.
  static FileError open(std::span<const std::byte> bytes, FileView* view);

  std::span<const NetworkRecord> networks() const { return networks_; }
  std::span<const LayerRecord> layers() const { return layers_; }
  std::span<const LayerRecord> layers(const NetworkRecord& network) const;
  // All tensors: those of layers in the order of the layers, then the constants.
  std::span<const TensorRecord> tensors() const { return tensors_; }
  std::span<const TensorRecord> constants() const { return constants_; }
  std::span<const MetadataRecord> metadata() const { return metadata_; }
  const std::array<std::uint8_t, 32>& sha256() const { return sha256_; }

  std::string_view text(StringRef string) const;  // of any record's name, key or value
  std::span<const std::byte> data(const TensorRecord& tensor) const;
  std::span<const std::uint16_t> fp16(const TensorRecord& tensor) const;  // empty for another type
  std::span<const float> fp32(const TensorRecord& tensor) const;          // empty for another type

  // Null or nothing where there is none of that name.
  const NetworkRecord* find_network(std::string_view name) const;
  const TensorRecord* find_constant(std::string_view name) const;
  std::optional<std::string_view> find_metadata(std::string_view key) const;

 private:
  friend class FileValidator;

  std::span<const std::byte> bytes_;
  std::span<const NetworkRecord> networks_;
  std::span<const LayerRecord> layers_;
  std::span<const TensorRecord> tensors_;
  std::span<const TensorRecord> constants_;
  std::span<const MetadataRecord> metadata_;
  std::span<const std::byte> pool_;
  std::array<std::uint8_t, 32> sha256_{};
};

}  // namespace mien::formats
