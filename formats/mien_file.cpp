// Messages and look-up by name.
#include "formats/mien_file.h"

namespace mien::formats {
namespace {

struct Message {
  FileStatus status;
  const char* text;
};

constexpr Message kMessages[] = {
    {FileStatus::kOk, "ok"},
    {FileStatus::kMisaligned, "file in memory: misaligned (expected 64 bytes)"},
    {FileStatus::kTruncated, "truncated: fewer bytes than the header declares"},
    {FileStatus::kTrailingBytes, "trailing bytes after the end of the file"},
    {FileStatus::kBadMagic, "not a .mien file"},
    {FileStatus::kUnsupportedVersion, "unsupported version of the format"},
    {FileStatus::kWrongEndian, "byte order: not little-endian"},
    {FileStatus::kBadChecksum, "checksum: mismatch, the file is damaged"},
    {FileStatus::kLimitExceeded, "count or size: exceeds a limit of the format"},
    {FileStatus::kReservedNotZero, "reserved field: not zero"},
    {FileStatus::kHole, "section, string or tensor: not adjacent to the previous one"},
    {FileStatus::kPaddingNotZero, "padding: not zero"},
    {FileStatus::kBadName, "name: too long, empty, or with characters other than a-z 0-9 _ . /"},
    {FileStatus::kDuplicateName, "name: duplicate network, constant or metadata key"},
    {FileStatus::kBadMetadata, "metadata value: too long or not plain UTF-8 text"},
    {FileStatus::kBadType, "tensor: unknown data type"},
    {FileStatus::kBadDims, "tensor: rank or dimensions out of range"},
    {FileStatus::kBadTensorBytes, "tensor: size does not match its dimensions and data type"},
    {FileStatus::kNonFinite, "tensor: NaN or infinity"},
    {FileStatus::kBadNetwork, "network: input, flags, layers or outputs out of range"},
    {FileStatus::kBadOp, "layer: operation unknown or not allowed in the network"},
    {FileStatus::kBadActivation, "layer: activation unknown or not allowed for the operation"},
    {FileStatus::kBadReference, "layer: input is not an earlier value"},
    {FileStatus::kBadShape, "layer: output shape does not match the inputs"},
    {FileStatus::kBadKernel, "layer: kernel, stride, padding or flags out of range"},
    {FileStatus::kBadTensor, "layer: tensors do not match the operation"},
    {FileStatus::kUnusedTensor, "tensor: neither used by a layer nor named"},
};

}  // namespace

const char* message(FileStatus status) {
  for (const Message& known : kMessages) {
    if (known.status == status) {
      return known.text;
    }
  }
  return "unknown status";
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
