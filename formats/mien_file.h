// Reads a weight file in place: one validating pass, without allocation or copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "formats/error_detail.h"
#include "formats/mien_format.h"

namespace mien::formats {

class FileView;

// Checks every rule of docs/format.md. Sets `view` only on MIEN_OK; it refers to `bytes`, which
// must be kFileAlignment-aligned and outlive it unchanged.
[[nodiscard]] mien_error_detail open(std::span<const std::byte> bytes, FileView& view);

class FileView {
 public:
  FileView() = default;

  [[nodiscard]] std::span<const NetworkRecord> networks() const { return networks_; }
  [[nodiscard]] std::span<const LayerRecord> layers(const NetworkRecord& network) const {
    return layers_.subspan(network.first_layer, network.layer_count);
  }
  [[nodiscard]] std::span<const TensorRecord> tensors() const { return tensors_; }
  [[nodiscard]] std::span<const MetadataRecord> metadata() const { return metadata_; }
  [[nodiscard]] std::string_view text(StringRef ref) const {
    return strings_.substr(ref.offset, ref.bytes);
  }
  [[nodiscard]] std::span<const std::byte> data(const TensorRecord& tensor) const {
    return bytes_.subspan(static_cast<std::size_t>(tensor.offset),
                          static_cast<std::size_t>(tensor.bytes));
  }
  [[nodiscard]] std::size_t file_bytes() const { return bytes_.size(); }
  [[nodiscard]] std::uint64_t checksum() const { return checksum_; }

  // nullptr if the name is unknown.
  [[nodiscard]] const NetworkRecord* find_network(std::string_view name) const;
  [[nodiscard]] const TensorRecord* find_constant(std::string_view name) const;

 private:
  friend mien_error_detail open(std::span<const std::byte> bytes, FileView& view);

  std::span<const std::byte> bytes_;
  std::span<const NetworkRecord> networks_;
  std::span<const LayerRecord> layers_;
  std::span<const TensorRecord> tensors_;
  std::span<const MetadataRecord> metadata_;
  std::string_view strings_;
  std::uint64_t checksum_ = 0;
};

}  // namespace mien::formats
