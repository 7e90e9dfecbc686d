// Reads a weight file in place: one validating pass, without allocation or copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "formats/mien_format.h"

namespace mien::formats {

enum class FileStatus : std::int32_t {
  kOk = 0,
  // the file as a whole
  kMisaligned = 1,  // the memory is not kFileAlignment-aligned
  kTruncated = 2,
  kTrailingBytes = 3,
  kBadMagic = 4,
  kUnsupportedVersion = 5,
  kWrongEndian = 6,
  kBadChecksum = 7,
  kLimitExceeded = 8,
  kReservedNotZero = 9,
  // sections
  kHole = 20,
  kPaddingNotZero = 21,
  kBadName = 22,
  kDuplicateName = 23,
  kBadMetadata = 24,
  // tensors
  kBadType = 40,
  kBadDims = 41,
  kBadTensorBytes = 42,
  kNonFinite = 43,
  // networks and layers
  kBadNetwork = 60,
  kBadOp = 61,
  kBadActivation = 62,
  kBadReference = 63,
  kBadShape = 64,
  kBadKernel = 65,
  kBadTensor = 66,  // a tensor's dimensions do not match the layer's op
  kUnusedTensor = 67,
};

// A static string of one line.
[[nodiscard]] const char* message(FileStatus status);

struct Validation {
  FileStatus status = FileStatus::kOk;
  std::uint64_t offset = 0;  // position of the fault in the file, bytes
};

class FileView;

// Checks every rule of docs/format.md. Sets `view` only on kOk; it refers to `bytes`, which must
// outlive it unchanged.
[[nodiscard]] Validation open(std::span<const std::byte> bytes, FileView& view);

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
  friend Validation open(std::span<const std::byte> bytes, FileView& view);

  std::span<const std::byte> bytes_;
  std::span<const NetworkRecord> networks_;
  std::span<const LayerRecord> layers_;
  std::span<const TensorRecord> tensors_;
  std::span<const MetadataRecord> metadata_;
  std::string_view strings_;
  std::uint64_t checksum_ = 0;
};

}  // namespace mien::formats
